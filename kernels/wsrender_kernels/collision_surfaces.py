"""Closed surfaces that stand, in the snippets of `collision`: balls looked up in grids, and triangles one by one.

A grid holds bounds of the signed distance over its cells. What no ball decides is tested against the triangles that are
near; a solid that touches none is inside or outside as a whole, which a ray from its middle tells.
"""

LOOKUPS = """
    for (int k = 0; k < program.n_lookups; k++) {
        const int* row = program.lookups.data + 5 * k; const int* n = program.grid_shapes.data + 4 * row[1];
        const float* g = program.grid_numbers.data + 4 * row[1]; const float* b = program.balls.data + 5 * row[3];
        const unsigned* __restrict words = program.grid_words.data + n[3];
        const float o0 = g[0], o1 = g[1], o2 = g[2], per = 1.f / g[3];
        const float e0 = (float)(n[0] - 1), e1 = (float)(n[1] - 1), e2 = (float)(n[2] - 1);
        const int pair = row[0], s0 = n[1] * n[2], s1 = n[2];
        const float* __restrict S = F + 12 * row[2] * LN;
        unsigned* __restrict ht = hit_ + (int)program.pair_numbers.data[2 * pair + 1] * LN;
        unsigned* __restrict mask = masks + (pair >> 5) * LN; const unsigned bit = 1u << (pair & 31);
        for (int i = 0; i < row[4]; i++, b += 5) {
            const float c0 = b[0], c1 = b[1], c2 = b[2], free = b[3], touch = b[4];
            LANE_LOOP {
                float x = (S[9 * LN + l] + S[l] * c0 + S[3 * LN + l] * c1 + S[6 * LN + l] * c2 - o0) * per;
                float y = (S[10 * LN + l] + S[LN + l] * c0 + S[4 * LN + l] * c1 + S[7 * LN + l] * c2 - o1) * per;
                float z = (S[11 * LN + l] + S[2 * LN + l] * c0 + S[5 * LN + l] * c1 + S[8 * LN + l] * c2 - o2) * per;
                x = x > 0.f ? x : 0.f; x = x < e0 ? x : e0;
                y = y > 0.f ? y : 0.f; y = y < e1 ? y : e1;
                z = z > 0.f ? z : 0.f; z = z < e2 ? z : e2;
                unsigned word = words[(int)x * s0 + (int)y * s1 + (int)z];
                float low = (float)(short)(word & 65535u), high = (float)(short)(word >> 16);
                mask[l] |= low <= free ? bit : 0u;
                ht[l] |= high < touch ? 1u : 0u;
            }
        }
    }
"""

TRIANGLES = """
    // 0 outside, 1 inside, 2 unknown: how often a ray leaves the solid (Möller and Trumbore 1997).
    auto side_of = [&](const real* p, int first, int end, real eps) -> V {
        const real directions[9] = {0.36, 0.48, 0.8, -0.64, 0.48, 0.6, 0.28, -0.936, 0.2133};
        for (int k = 0; k < 3; k++) {
            real d[3], e1[3], e2[3], r[3], h[3], s[3];
            for (int i = 0; i < 3; i++) d[i] = directions[3 * k + i];
            unit(d);
            int leaves = 0; bool clear = true;
            for (int node = first; node < end && clear;) {
                const real* own = program.nodes.data + 4 * node; const int* link = program.node_links.data + 3 * node;
                for (int i = 0; i < 3; i++) r[i] = own[i] - p[i];
                const real along = dot(r, d), wide = own[3] + eps;
                const real across2 = dot(r, r) - along * along;
                if (along < -wide || across2 > wide * wide * real(1.001)) { node = link[0]; continue; }
                node++;
                for (int t = link[1]; t < link[1] + link[2] && clear; t++) {
                    const real* v = program.triangles.data + 9 * t;
                    for (int i = 0; i < 3; i++) { e1[i] = v[3 + i] - v[i]; e2[i] = v[6 + i] - v[i]; }
                    for (int i = 0; i < 3; i++) s[i] = p[i] - v[i];
                    cross(d, e2, h);
                    const real det = dot(e1, h), size = @SQRT(dot(e1, e1) * dot(e2, e2));
                    if (!(det > real(@GRAZING) * size || det < -real(@GRAZING) * size)) { clear = false; break; }
                    const real u = dot(s, h) / det;
                    cross(s, e1, h);
                    const real w = dot(d, h) / det, least = u < w ? (u < 1 - u - w ? u : 1 - u - w)
                                                                 : (w < 1 - u - w ? w : 1 - u - w);
                    if (least < -real(@BESIDE) || dot(e2, h) / det < 0) continue;
                    if (least < real(@BESIDE)) { clear = false; break; }
                    leaves += det < 0 ? 1 : -1;
                }
            }
            if (clear) return leaves > 0 ? TOUCHING : APART;
        }
        return OPEN;
    };
    // Of a surface and a solid in the frame S, itself turned by RB and moved to pB.
    auto against_surface = [&](real margin, int a, const Solids& b, const real* S, const real* RB, const real* pB,
                               real eps) {
        if (!(eps < real(1e29f))) return OPEN;
        const int* range = program.vertex_range.data + 2 * @CELLS * a;
        const int first = range[0], end = range[1];
        const real* c = program.solid_capsules.data + 7 * b.number[0];
        const real ball = margin + b.own[12];
        real m[3], axis[3];
        for (int k = 0; k < 3; k++) {
            m[k] = S[9 + k] + S[k] * c[0] + S[3 + k] * c[1] + S[6 + k] * c[2];
            axis[k] = S[k] * c[3] + S[3 + k] * c[4] + S[6 + k] * c[5];
        }
        const real length = dot(axis, axis) + real(1e-12);
        bool open = false;
        for (int node = first; node < end;) {
            const real* own = program.nodes.data + 4 * node; const int* link = program.node_links.data + 3 * node;
            real r[3] = {own[0] - m[0], own[1] - m[1], own[2] - m[2]};
            real share = dot(r, axis) / length, wide = c[6] + margin + eps + own[3];
            share = share < 1 ? share : real(1); share = share > -1 ? share : real(-1);
            for (int k = 0; k < 3; k++) r[k] -= share * axis[k];
            if (dot(r, r) > wide * wide) { node = link[0]; continue; }
            node++;
            for (int t = link[1]; t < link[1] + link[2]; t++) {
                const real* v = program.triangles.data + 9 * t;
                auto farthest = [&](const real* d, bool live, real* o) {
                    const real x = dot(v, d), y = dot(v + 3, d), z = dot(v + 6, d);
                    const real* low = v + (x < y ? (x < z ? 0 : 6) : (y < z ? 3 : 6));
                    real l[3], p[3];
                    for (int k = 0; k < 3; k++) l[k] = RB[k] * d[0] + RB[3 + k] * d[1] + RB[6 + k] * d[2];
                    support(b, l, live, p);
                    for (int k = 0; k < 3; k++) o[k] = pB[k] + dot(RB + 3 * k, p) + ball * d[k] - low[k];
                };
                real v0[3];
                for (int k = 0; k < 3; k++) v0[k] = pB[k] - (v[k] + v[3 + k] + v[6 + k]) / 3;
                const V found = portal_of(farthest, v0, true, eps);
                if (found == TOUCHING) return TOUCHING;
                open |= found == OPEN;
            }
        }
        return open ? OPEN : side_of(pB, first, end, eps);
    };
"""
