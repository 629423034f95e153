"""Many solids that stand, in the snippet of the filter of `collision`: balls of moving solids are looked up in cells.

A cell says how near the nearest is, and which are near at all. Only pairs with those are tested, sample by sample. On
CUDA all pairs are tested: by code that is written out, or beside surfaces and beyond `MOST_TESTS` by what reads data.
"""

AT_ONCE = 32  # balls of a solid, at most

CROWD = """
    alignas(64) unsigned looked_up_[@CROWD_BALLS * LN], near_[LN];
    alignas(64) int cell_[LN];
    unsigned* __restrict looked_up = looked_up_; unsigned* __restrict near = near_;
    int* __restrict cell = cell_;
    {
        const float* g = program.crowd_numbers.data; const int* n = program.crowd_shape.data;
        const unsigned* __restrict words = program.crowd_words.data;
        const float o0 = g[0], o1 = g[1], o2 = g[2], per = 1.f / g[3];
        const float e0 = (float)(n[0] - 1), e1 = (float)(n[1] - 1), e2 = (float)(n[2] - 1);
        const int s0 = n[1] * n[2], s1 = n[2];
        for (int l = 0; l < LN; l++) near[l] = 0u;
        for (int r = 0; r < program.n_crowd_rows; r++) {
            const int* row = program.crowd_rows.data + 3 * r;
            const float* __restrict S = F + 12 * row[0] * LN;
            const unsigned bit = 1u << (r & 31);
            for (int i = row[1]; i < row[1] + row[2]; i++) {
                const float* b = program.crowd_balls.data + 4 * i;
                const float c0 = b[0], c1 = b[1], c2 = b[2], free = b[3];
                unsigned* __restrict D = looked_up + i * LN;
                LANE_LOOP {
                    float x = S[9 * LN + l] + S[l] * c0 + S[3 * LN + l] * c1 + S[6 * LN + l] * c2;
                    float y = S[10 * LN + l] + S[LN + l] * c0 + S[4 * LN + l] * c1 + S[7 * LN + l] * c2;
                    float z = S[11 * LN + l] + S[2 * LN + l] * c0 + S[5 * LN + l] * c1 + S[8 * LN + l] * c2;
                    x = (x - o0) * per; y = (y - o1) * per; z = (z - o2) * per;
                    x = x > 0.f ? x : 0.f; x = x < e0 ? x : e0;
                    y = y > 0.f ? y : 0.f; y = y < e1 ? y : e1;
                    z = z > 0.f ? z : 0.f; z = z < e2 ? z : e2;
                    cell[l] = (int)x * s0 + (int)y * s1 + (int)z;
                }
                LANE_LOOP D[l] = words[cell[l]];
                LANE_LOOP near[l] |= (float)((int)(D[l] << 16) >> 16) <= free ? bit : 0u;
            }
        }
    }
    // Squared distance of the axes of what stands and what moves. Frames are not read here: that single numbers of them
    // are, keeps clang from taking the loop that makes them to SIMD.
    auto between = [&](int test, int l) {
        const int* ends = program.tests.data + 2 * test;
        const float* A = program.capsules.data + 6 * ends[0]; const float* B = C + 6 * ends[1] * LN + l;
        const float* G = A + 3; const float* H = B + 3 * LN;
        const float* t = program.test_numbers.data + 5 * test;
        float r0 = A[0] - B[0], r1 = A[1] - B[LN], r2 = A[2] - B[2 * LN];
        float g0 = G[0], g1 = G[1], g2 = G[2], h0 = H[0], h1 = H[LN], h2 = H[2 * LN];
        float b = g0 * h0 + g1 * h1 + g2 * h2, c = g0 * r0 + g1 * r1 + g2 * r2, f = h0 * r0 + h1 * r1 + h2 * r2;
        auto within = [](float x, float most) { x = x < most ? x : most; return x > -most ? x : -most; };
        float s = within((b * f - c) / (1.000001f - b * b), t[0]);
        float w = within(b * s + f, t[1]);
        s = within(b * w - c, t[0]);
        r0 += g0 * s - h0 * w; r1 += g1 * s - h1 * w; r2 += g2 * s - h2 * w;
        return r0 * r0 + r1 * r1 + r2 * r2;
    };
    const int set_words = program.crowd_set_words;
    for (int l = 0; l < LN; l++) {
        for (unsigned rows = hit_[l] ? 0u : near[l]; rows; rows &= rows - 1u)
        for (int r = __builtin_ctz(rows); r < program.n_crowd_rows; r += 32) {
            const int* row = program.crowd_rows.data + 3 * r;
            int sets[@AT_ONCE], count = 0;
            for (int i = row[1]; i < row[1] + row[2]; i++) {
                const unsigned word = looked_up[i * LN + l];
                sets[count] = (int)(word >> 16) * set_words;
                count += (float)(short)(word & 65535u) <= program.crowd_balls.data[4 * i + 3] ? 1 : 0;
            }
            for (int w = 0; w < set_words; w++) {
                unsigned named = 0u;
                for (int k = 0; k < count; k++) named |= program.crowd_sets.data[sets[k] + w];
                for (; named; named &= named - 1u) {
                    const int* own = program.crowd_pairs.data + 5 * (32 * (r * set_words + w) + __builtin_ctz(named));
                    const int pair = own[0];
                    if (pair < 0) continue;
                    unsigned* hit = hit_ + (int)program.pair_numbers.data[2 * pair + 1] * LN + l;
                    if (hit_[l] | *hit) continue;
                    bool open = false, touching = false;
                    for (int i = own[1]; i < own[1] + own[2] && !open; i++)
                        open = between(i, l) < program.test_numbers.data[5 * i + 2];
                    for (int i = own[3]; i < own[3] + own[4] && open && !touching; i++)
                        touching = between(i, l) < program.test_numbers.data[5 * i + 3];
                    if (touching) *hit = 1u;
                    else if (open) masks[(pair >> 5) * LN + l] |= 1u << (pair & 31);
                }
            }
        }
    }
"""
