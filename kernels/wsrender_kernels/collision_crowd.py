"""Many solids that stand, in the snippet of the filter of `collision`: balls of moving solids are looked up in cells.

A cell says how near the nearest is, and which are near at all. Only pairs with those are tested, sample by sample,
SIDE_BY_SIDE at a time: axes of what moves against boxes, of which those without a width are axes or points. On
CUDA all pairs are tested: by code that is written out, or beside surfaces and beyond `MOST_TESTS` by what reads data.
"""

AT_ONCE = 32  # balls of a solid, at most
SIDE_BY_SIDE = 16  # tests
WITHIN = 36  # tests of a pair by what lies within its solids, at most

CROWD = """
    alignas(64) unsigned looked_up_[@CROWD_BALLS * LN], near_[LN];
    alignas(64) int cell_[LN], nearest_[LN];
    unsigned* __restrict looked_up = looked_up_; unsigned* __restrict near = near_;
    int* __restrict cell = cell_; int* __restrict nearest = nearest_;
    {
        const float* g = program.crowd_numbers.data; const int* n = program.crowd_shape.data;
        const unsigned* __restrict words = program.crowd_words.data;
        const float o0 = g[0], o1 = g[1], o2 = g[2], per = 1.f / g[3];
        const float e0 = (float)(n[0] - 1), e1 = (float)(n[1] - 1), e2 = (float)(n[2] - 1);
        const int s0 = n[1] * n[2], s1 = n[2];
        for (int l = 0; l < LN; l++) { near[l] = 0u; nearest[l] = 0x7fffffff; }
        for (int r = 0; r < program.n_crowd_rows; r++) {
            const int* row = program.crowd_rows.data + 3 * r;
            const float* __restrict S = F + 12 * row[0] * LN;
            const unsigned bit = 1u << (r & 31);
            for (int i = row[1]; i < row[1] + row[2]; i++) {
                const float* b = program.crowd_balls.data + 4 * i;
                const float c0 = b[0], c1 = b[1], c2 = b[2];
                const int free = (int)b[3];
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
                LANE_LOOP {
                    int over = ((int)(D[l] << 16) >> 16) - free, ball = over * 65536 + (i & 65535);
                    near[l] |= over <= 0 ? bit : 0u;
                    nearest[l] = ball < nearest[l] ? ball : nearest[l];
                }
            }
        }
    }
    // Tests wait until there are so many. Frames are not read here: that single numbers of them are, keeps clang from
    // taking the loop that makes them to SIMD.
    struct Asked { int lane, owner, test; } asked_[@SIDE_BY_SIDE * @WITHIN];
    int asked = 0;
    typedef float X __attribute__((ext_vector_type(@SIDE_BY_SIDE)));
    auto decide = [&]() {
        constexpr int GROUP = @SIDE_BY_SIDE;
        const int some = asked < GROUP ? asked : GROUP;
        alignas(64) float of_capsule[6][GROUP], of_box[15][GROUP], of_test[3][GROUP], square[GROUP];
        Asked own[GROUP];
        asked -= some;
        for (int i = 0; i < GROUP; i++) {
            own[i] = asked_[asked + (i < some ? i : 0)];
            const int* ends = program.tests.data + 2 * own[i].test;
            const float* A = program.crowd_boxes.data + 16 * ends[0];
            const float* B = C + 6 * ends[1] * LN + own[i].lane;
            const float* t = program.test_numbers.data + 5 * own[i].test;
            for (int k = 0; k < 6; k++) of_capsule[k][i] = B[k * LN];
            for (int k = 0; k < 15; k++) of_box[k][i] = A[k];
            for (int k = 0; k < 3; k++) of_test[k][i] = t[1 + k];
        }
        const X* m = (const X*)of_capsule; const X* h = m + 3; const X* axes = (const X*)of_box;
        const X* size = axes + 12; const X most = *(const X*)of_test;
        X p[3], u[3], d[3];
        for (int k = 0; k < 3; k++) d[k] = m[k] - axes[9 + k];
        for (int k = 0; k < 3; k++) {
            p[k] = axes[3 * k] * d[0] + axes[3 * k + 1] * d[1] + axes[3 * k + 2] * d[2];
            u[k] = axes[3 * k] * h[0] + axes[3 * k + 1] * h[1] + axes[3 * k + 2] * h[2];
        }
        // As in `segments.box_distance`.
        auto within = [](X x, X most) { x = x < most ? x : most; return x > -most ? x : -most; };
        auto beyond = [&](X t, int k) { X x = p[k] + t * u[k]; return x - within(x, size[k]); };
        auto slope = [&](X t) { return beyond(t, 0) * u[0] + beyond(t, 1) * u[1] + beyond(t, 2) * u[2]; };
        X low = -most, high = most, below = slope(low), above = slope(high);
        for (int k = 0; k < 3; k++) {
            const X per = 1.f / u[k];
            for (int side = 0; side < 2; side++) {
                X t = within(((side ? size[k] : -size[k]) - p[k]) * per, most), now = slope(t);
                auto lower = (now <= 0.f) & (t > low), upper = (now >= 0.f) & (t < high);
                low = lower ? t : low; below = lower ? now : below;
                high = upper ? t : high; above = upper ? now : above;
            }
        }
        X share = -below / (above - below);
        share = share < 1.f ? share : (X)1.f;
        share = share > 0.f ? share : (X)0.f;
        const X t = low + (high - low) * share;
        X square_of = (X)0.f;
        for (int k = 0; k < 3; k++) { X x = beyond(t, k); square_of += x * x; }
        *(X*)square = square_of;
        for (int i = 0; i < some; i++) {
            const int l = own[i].lane;
            const int* pair = program.crowd_pairs.data + 5 * own[i].owner;
            unsigned* hit = hit_ + (int)program.pair_numbers.data[2 * pair[0] + 1] * LN + l;
            if (square[i] < of_test[2][i]) *hit = 1u;
            if (*hit || !(square[i] < of_test[1][i])) continue;
            unsigned* mask = masks + (pair[0] >> 5) * LN + l; const unsigned bit = 1u << (pair[0] & 31);
            if (*mask & bit) continue;
            *mask |= bit;
            for (int k = 0; k < pair[4]; k++) asked_[asked++] = {l, own[i].owner, pair[3] + k};
        }
    };
    const int set_words = program.crowd_set_words;
    auto ask = [&](int l, int owner) {
        const int* own = program.crowd_pairs.data + 5 * owner;
        if (own[0] < 0 || (hit_[l] | hit_[(int)program.pair_numbers.data[2 * own[0] + 1] * LN + l])) return;
        for (int k = 0; k < own[2]; k++) {
            asked_[asked++] = {l, owner, own[1] + k};
            while (asked >= @SIDE_BY_SIDE) decide();
        }
    };
    // One of those at the nearest ball first: where it touches, as most do that touch any, no other is asked.
    for (int l = 0; l < LN; l++) {
        if (hit_[l] || !near[l]) continue;
        const int i = nearest[l] & 65535, set = (int)(looked_up[i * LN + l] >> 16);
        ask(l, 32 * program.crowd_ball_rows.data[i] * set_words + program.crowd_first.data[set]);
    }
    while (asked) decide();
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
                for (; named; named &= named - 1u) ask(l, 32 * (r * set_words + w) + __builtin_ctz(named));
            }
        }
    }
    while (asked) decide();
"""
