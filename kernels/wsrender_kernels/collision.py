"""Whether the solids of a robot and its surroundings touch: a filter of certified tests, then a narrow phase.

``filter``: on the CPU a task is a block of LANES samples, of which PART_LANES at a time go through loops over joints,
capsules, tests and tables around lane loops, which clang turns into SIMD: the robot is data, and one kernel serves all
with the same numbers of coordinates and joints. On CUDA a thread takes a sample through the same code, of one lane.
It labels a sample ADMITTED or with the number of the reason, from 1; a sample with pairs that no test decides is listed
with a mask of those. ``narrow`` decides listed samples pair by pair: portals of the Minkowski difference (Snethen,
*XenoCollide*, 2008), certified by a gap along a direction or by a portal that the origin lies behind, each by more than
what float32 may be off; what is still open then is listed for the same in float64, and at last for the host. On the CPU
a task takes BATCH of them, a pair of each in turn, and GROUP whose solids are of the same kinds side by side: a V is so
many numbers, on CUDA one.
"""

from typing import Any

import warp as wp

from wsrender_kernels.collision_crowd import AT_ONCE, CROWD, SIDE_BY_SIDE, WITHIN
from wsrender_kernels.collision_surfaces import LOOKUPS, TRIANGLES
from wsrender_kernels.factories import factory
from wsrender_kernels.options import CUDA_OPTIONS, MODULE_OPTIONS, SHORT_OPTIONS
from wsrender_kernels.sampling import LANES, blocks, sample_space, sampling

PART_LANES = 64
TOGETHER = 32  # lanes of the filter that a far pair is left early for
BATCH, GROUP = 512, 16  # open samples of a task of the narrow phase on the CPU, and side by side
STEPS = 40  # of portals
EDGE, ROW = 8, 8  # cells of directions along the edge of a cube; vertices of a cell are padded to so many
CAPACITY = 16  # capsules, and balls of a crowd: the scratch is for a multiple of so many

# What the narrow phase computes with.
REAL_ARRAYS = (
    "joints",
    "solids",
    "solid_sizes",
    "vertices",
    "pair_numbers",
    "nodes",
    "triangles",
    "solid_capsules",
)
_ARRAYS = {
    wp.float32: ("lower", "upper", "capsules", "test_numbers", "table_numbers", "balls", "grid_numbers",
                 "crowd_numbers", "crowd_balls", "crowd_boxes"),
    wp.int32: ("sources", "capsule_frame", "capsule_axis", "pairs", "planes", "tests", "tables", "table_columns",
               "solid_frame", "vertex_range", "solid_pairs", "pair_kinds", "pair_ranks", "lookups", "grid_shapes",
               "node_links", "crowd_shape", "crowd_first", "crowd_rows", "crowd_ball_rows", "crowd_pairs"),
    wp.uint32: ("table_words", "first_reason", "grid_words", "crowd_words", "crowd_sets"),
}  # fmt: skip
ARRAYS = {name: dtype for dtype, names in _ARRAYS.items() for name in names}


@factory
def program_type(real: Any):
    """Struct with the arrays of a `wsrender.collision.program.Program`, flat, and their numbers of rows."""

    class CollisionProgram:
        n_capsules: wp.int32
        n_pairs: wp.int32
        n_planes: wp.int32
        n_tables: wp.int32
        n_solid_pairs: wp.int32
        n_lookups: wp.int32
        n_crowd_rows: wp.int32
        crowd_set_words: wp.int32
        root: wp.int32  # lowest frame that a solid is in: all others are taken from it
        columns: wp.int32  # cells of a table along its first coordinate
        epsilon: real

    for name, dtype in [*ARRAYS.items(), *((name, real) for name in REAL_ARRAYS)]:
        CollisionProgram.__annotations__[name] = wp.array(dtype=dtype)
    return wp.struct(CollisionProgram)


_SINCOS = """
#if defined(__CUDA_ARCH__)
    auto bits_of = [](float x) { return __float_as_uint(x); };
    auto float_of = [](unsigned x) { return __uint_as_float(x); };
#else
    auto bits_of = [](float x) { unsigned bits; __builtin_memcpy(&bits, &x, 4); return bits; };
    auto float_of = [](unsigned x) { float value; __builtin_memcpy(&value, &x, 4); return value; };
#endif
    auto sincos_of = [&](float a, float& sine, float& cosine) {
        float shifted = a * 0.6366197723675814f + 12582912.f, quarter = shifted - 12582912.f;
        float r = (a - quarter * 1.57079637050628662109375f) + quarter * 4.37113900018624283e-8f, z = r * r;
        float s = r + r * z * (-1.6666654611e-1f + z * (8.3321608736e-3f - z * 1.9515295891e-4f));
        float c = 4.166664568298827e-2f + z * (-1.388731625493765e-3f + z * 2.443315711809948e-5f);
        c = 1.f + z * (-0.5f + z * c);
        unsigned m = bits_of(shifted), us = bits_of((m & 1u) ? c : s), uc = bits_of((m & 1u) ? s : c);
        us ^= (m << 30) & 0x80000000u;
        uc ^= ((m << 30) + 0x40000000u) & 0x80000000u;
        sine = float_of(us);
        cosine = float_of(uc);
    };
"""

_KINEMATICS = """    for (int l = 0; l < LN; l++)
        for (int k = 0; k < 12; k++) F[(12 * program.root + k) * LN + l] = (k == 0 || k == 4 || k == 8) ? 1.f : 0.f;
    for (int i = program.root; i < L; i++) {
        const real* t = program.joints.data + 15 * i;
        const real* __restrict S = F + 12 * i * LN; real* __restrict D = F + 12 * (i + 1) * LN;
        const real* __restrict v = Q + program.sources.data[i] * STRIDE;
        const real scale = t[12], offset = t[13], turns = t[14];
        LANE_LOOP {
            real moved = scale * v[l] + offset, angle = turns * moved, slide = moved - angle, s, c;
            sincos_of(angle, s, c);
            for (int k = 0; k < 3; k++) {
                real X = S[k * LN + l], Y = S[(3 + k) * LN + l], Z = S[(6 + k) * LN + l];
                real x = X * t[0] + Y * t[3] + Z * t[6], y = X * t[1] + Y * t[4] + Z * t[7];
                real z = X * t[2] + Y * t[5] + Z * t[8];
                D[k * LN + l] = c * x + s * y;
                D[(3 + k) * LN + l] = c * y - s * x;
                D[(6 + k) * LN + l] = z;
                D[(9 + k) * LN + l] = S[(9 + k) * LN + l] + X * t[9] + Y * t[10] + Z * t[11] + slide * z;
            }
        }
    }"""

_FILTER = """
#if defined(__CUDA_ARCH__)
    #define LANE_LOOP for (int l = 0; l < LN; l++)
    constexpr int LN = 1, STRIDE = 1, GROUP = 1;
    typedef float V;
    typedef unsigned U;
    auto any = [](bool m) { return m; };
#else
    #define LANE_LOOP _Pragma("clang loop vectorize(assume_safety) interleave_count(1)") for (int l = 0; l < LN; l++)
    constexpr int LN = @LANES, STRIDE = @BLOCK, GROUP = @TOGETHER;
    typedef float V __attribute__((ext_vector_type(@TOGETHER)));
    typedef unsigned U __attribute__((ext_vector_type(@TOGETHER)));
    auto any = [](auto m) { return __builtin_reduce_or(m) != 0; };
#endif
    typedef float real;
    auto of = [](const float* row, int at) { return *(const V*)(row + at); };
    auto clamped = [](V x, float most) { x = x < most ? x : most; return x > -most ? x : -most; };
    auto set = [](unsigned* to, auto where, unsigned bit) { U& old = *(U*)to; old |= where ? (U)bit : (U)0u; };
    constexpr int N = @N, L = @L, CAP = @CAP, W = @W;
@SINCOS
    alignas(64) float frames_[12 * (L + 1) * LN], capsules_[6 * CAP * LN];
    alignas(64) unsigned masks_[W * LN], inside_[LN], hit_[2 * LN];
    float* __restrict F = frames_; float* __restrict C = capsules_;
    unsigned* __restrict masks = masks_; unsigned* __restrict inside = inside_;
    const float* __restrict q = &values.c[0];
    for (int part = 0; part * LN < valid; part++) {
    const float* __restrict Q = q + part * LN;
    for (int l = 0; l < LN; l++) {
        inside[l] = 1u;
        for (int w = 0; w < W; w++) masks[w * LN + l] = 0u;
        hit_[l] = 0u; hit_[LN + l] = 0u;
    }
    for (int i = 0; i < N; i++) {
        // Tables and proofs hold within the limits alone.
        const float low = program.lower.data[i], high = program.upper.data[i], slack = 4e-6f * (1.f + high - low);
        const float* __restrict v = Q + i * STRIDE;
        LANE_LOOP { float x = v[l]; inside[l] &= (x >= low - slack && x <= high + slack) ? 1u : 0u; }
    }
@KINEMATICS
    for (int i = 0; i < program.n_capsules; i++) {
        const float* __restrict S = F + 12 * program.capsule_frame.data[i] * LN; float* __restrict D = C + 6 * i * LN;
        const float* c = program.capsules.data + 6 * i;
        LANE_LOOP for (int k = 0; k < 3; k++)
            D[k * LN + l] = S[(9 + k) * LN + l] + S[k * LN + l] * c[0] + S[(3 + k) * LN + l] * c[1]
                + S[(6 + k) * LN + l] * c[2];
        if (program.capsule_axis.data[i] >= 0) continue;
        LANE_LOOP for (int k = 0; k < 3; k++)
            D[(3 + k) * LN + l] = S[k * LN + l] * c[3] + S[(3 + k) * LN + l] * c[4] + S[(6 + k) * LN + l] * c[5];
    }
    // Most axes are those of their frames.
    auto axis_of = [&](int capsule) -> const float* {
        const int row = program.capsule_axis.data[capsule];
        return row < 0 ? C + (6 * capsule + 3) * LN : F + row * LN;
    };
    // GROUP lanes at a time: where middles are mostly far apart, those of all often are.
    for (int p = 0; p < program.n_pairs; p++) {
        const int* row = program.pairs.data + 3 * p;
        const int pair = row[0], end = row[1] + row[2];
        unsigned* __restrict ht = hit_ + (int)program.pair_numbers.data[2 * pair + 1] * LN;
        unsigned* __restrict mask = masks + (pair >> 5) * LN; const unsigned bit = 1u << (pair & 31);
        for (int i = row[1]; i < end; i++) {
            const int a = program.tests.data[2 * i], b = program.tests.data[2 * i + 1];
            const float* __restrict A = C + 6 * a * LN; const float* __restrict G = axis_of(a);
            const float* __restrict B = C + 6 * b * LN; const float* __restrict H = axis_of(b);
            const float* t = program.test_numbers.data + 5 * i;
            const float most_s = t[0], most_w = t[1], near2 = t[2], hit2 = t[3], far2 = t[4];
            for (int l = 0; l < LN; l += GROUP) {
                V r0 = of(A, l) - of(B, l), r1 = of(A, LN + l) - of(B, LN + l);
                V r2 = of(A, 2 * LN + l) - of(B, 2 * LN + l);
                if (far2 > 0.f && !any(r0 * r0 + r1 * r1 + r2 * r2 < far2)) continue;
                if (most_s > 0.f) {
                    V g0 = of(G, l), g1 = of(G, LN + l), g2 = of(G, 2 * LN + l), c = g0 * r0 + g1 * r1 + g2 * r2;
                    if (most_w > 0.f) {
                        V h0 = of(H, l), h1 = of(H, LN + l), h2 = of(H, 2 * LN + l);
                        V b = g0 * h0 + g1 * h1 + g2 * h2, f = h0 * r0 + h1 * r1 + h2 * r2;
                        V w = clamped(b * clamped((b * f - c) / (1.000001f - b * b), most_s) + f, most_w);
                        r0 -= h0 * w; r1 -= h1 * w; r2 -= h2 * w;
                        c -= b * w;
                    }
                    V s = clamped(-c, most_s);
                    r0 += g0 * s; r1 += g1 * s; r2 += g2 * s;
                }
                V d2 = r0 * r0 + r1 * r1 + r2 * r2;
                set(mask + l, d2 < near2, bit);
                set(ht + l, d2 < hit2, 1u);
            }
        }
    }
    for (int p = 0; p < program.n_planes; p++) {
        const int* row = program.planes.data + 3 * p;
        const int pair = row[0];
        unsigned* __restrict ht = hit_ + (int)program.pair_numbers.data[2 * pair + 1] * LN;
        unsigned* __restrict mask = masks + (pair >> 5) * LN; const unsigned bit = 1u << (pair & 31);
        for (int i = row[1]; i < row[1] + row[2]; i++) {
            const int a = program.tests.data[2 * i], b = program.tests.data[2 * i + 1];
            const float* __restrict A = C + 6 * a * LN; const float* __restrict G = axis_of(a);
            const float* __restrict B = C + 6 * b * LN; const float* __restrict H = axis_of(b);
            const float* t = program.test_numbers.data + 5 * i;
            const float most = t[1], near1 = t[2], hit1 = t[3];
            LANE_LOOP {
                float n0 = G[l], n1 = G[LN + l], n2 = G[2 * LN + l];
                float h = (B[l] - A[l]) * n0 + (B[LN + l] - A[LN + l]) * n1 + (B[2 * LN + l] - A[2 * LN + l]) * n2;
                float along = most * (H[l] * n0 + H[LN + l] * n1 + H[2 * LN + l] * n2);
                h -= along > 0.f ? along : -along;
                mask[l] |= h < near1 ? bit : 0u;
                ht[l] |= h < hit1 ? 1u : 0u;
            }
        }
    }
    for (int k = 0; k < program.n_tables; k++) {
        const int* t = program.tables.data + 4 * k; const float* n = program.table_numbers.data + 4 * k;
        const float* __restrict u = Q + t[1] * STRIDE; const float* __restrict v = Q + t[2] * STRIDE;
        const unsigned* __restrict words = program.table_words.data + t[3];
        const int columns = program.table_columns.data[k], pair = t[0];
        const float last_u = (float)(program.columns - 1), last_v = (float)(columns - 1);
        unsigned* __restrict ht = hit_ + (int)program.pair_numbers.data[2 * pair + 1] * LN;
        unsigned* __restrict mask = masks + (pair >> 5) * LN; const unsigned bit = 1u << (pair & 31);
        LANE_LOOP {
            float x = (u[l] - n[0]) * n[1], y = (v[l] - n[2]) * n[3];
            x = x > 0.f ? x : 0.f; x = x < last_u ? x : last_u;
            y = y > 0.f ? y : 0.f; y = y < last_v ? y : last_v;
            int cell = (int)x * columns + (int)y;
            unsigned label = (words[cell >> 4] >> ((cell & 15) * 2)) & 3u;
            mask[l] |= label == 2u ? bit : 0u;
            ht[l] |= label == 1u ? 1u : 0u;
        }
    }
@LOOKUPS
@CROWD
    alignas(64) unsigned label_[LN], open_[LN];
    for (int l = 0; l < LN; l++) label_[l] = open_[l] = 0u;
    for (int w = 0; w < W; w++) {
        const unsigned first = program.first_reason.data[w];
        const unsigned* __restrict mask = masks + w * LN;
        LANE_LOOP open_[l] |= (hit_[LN + l] ? mask[l] & first : mask[l]);
    }
    LANE_LOOP {
        label_[l] = !inside[l] ? 0u : (hit_[l] ? 1u : (hit_[LN + l] ? 2u : 0u));
        open_[l] = !inside[l] ? 1u : (hit_[l] ? 0u : open_[l]);
    }
    const int some = valid - part * LN < LN ? valid - part * LN : LN, at = offset + part * LN;
    for (int l = 0; l < some; l++) labels.data[at + l] = (wp::uint8)label_[l];
    for (int l = 0; l < some; l++) {
        if (!open_[l]) continue;
#if defined(__CUDA_ARCH__)
        const int place = atomicAdd(listed.data, 1);
#else
        const int place = listed.data[0]++;
#endif
        ids.data[place] = at + l;
        for (int w = 0; w < W; w++) open_masks.data[(long long)place * W + w] = inside[l] ? masks[w * LN + l] : ~0u;
    }
    }
    #undef LANE_LOOP
"""

_UNROLLED = """
@SINCOS
    auto clamped = [](float x, float most) { return wp::max(wp::min(x, most), -most); };
    const float* q = &values.c[0];
@BODY
    unsigned any = 0u, first = 0u;
    for (int w = 0; w < @W; w++) { any |= masks[w]; first |= masks[w] & program.first_reason.data[w]; }
    int label = hit[0] ? 1 : (hit[1] ? 2 : 0);
    bool open = hit[0] ? false : (hit[1] ? first != 0u : any != 0u);
    if (!inside) { open = true; label = 0; }
    labels.data[offset] = (wp::uint8)label;
    if (open) {
#if defined(__CUDA_ARCH__)
        const int place = atomicAdd(listed.data, 1);
#else
        const int place = listed.data[0]++;
#endif
        ids.data[place] = offset;
        for (int w = 0; w < @W; w++) open_masks.data[(long long)place * @W + w] = inside ? masks[w] : ~0u;
    }
"""

_NARROW = """
    typedef @REAL real;
    constexpr int N = @N, L = @L, W = @W;
#if defined(__CUDA_ARCH__)
    #define LANE_LOOP for (int l = 0; l < LN; l++)
    constexpr int LN = 1, STRIDE = 1;
    #define ONCE
    #define LOWEST(bits) (__ffs(bits) - 1)
#else
    #define LANE_LOOP _Pragma("clang loop vectorize(assume_safety) interleave_count(1)") for (int l = 0; l < LN; l++)
    constexpr int LN = @BATCH, STRIDE = @BATCH;
    #define ONCE __attribute__((noinline))  // compiled once, not seven times
    #define LOWEST(bits) __builtin_ctz(bits)
#endif
#if defined(__CUDA_ARCH__) || @SURFACES
    constexpr int GROUP = 1;
    typedef real V;
    typedef bool M;
    auto any = [](M m) { return m; };
    auto root = [](V x) { return @SQRT(x); };
    auto whole = [](V x) { return (V)(int)x; };
#else
    constexpr int GROUP = @GROUP;
    typedef real V __attribute__((ext_vector_type(@GROUP)));
    typedef decltype(V() > V()) M;
    auto any = [](M m) { return __builtin_reduce_or(m) != 0; };
    auto root = [](V x) { return __builtin_elementwise_sqrt(x); };
    auto whole = [](V x) { return __builtin_elementwise_trunc(x); };
#endif
@TRIGONOMETRY
    alignas(64) real frames_[12 * (L + 1) * LN], eps_[LN];
    real* __restrict F = frames_;
    const real* __restrict Q = &values.c[0];
@KINEMATICS
    // What float32 may be off is known within the limits alone.
    for (int l = 0; l < LN; l++) eps_[l] = program.epsilon;
    for (int i = 0; i < N && sizeof(real) == 4; i++) {
        const float low = program.lower.data[i], high = program.upper.data[i], slack = 4e-6f * (1.f + high - low);
        const real* __restrict v = Q + i * STRIDE;
        LANE_LOOP { real x = v[l]; eps_[l] = x >= low - slack && x <= high + slack ? eps_[l] : real(1e30f); }
    }
    auto dot = [](const V* a, const V* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    auto cross = [](const V* a, const V* b, V* o) {
        o[0] = a[1] * b[2] - a[2] * b[1]; o[1] = a[2] * b[0] - a[0] * b[2]; o[2] = a[0] * b[1] - a[1] * b[0];
    };
    auto put = [](V* a, M where, const V* b) { for (int k = 0; k < 3; k++) a[k] = where ? b[k] : a[k]; };
    auto unit = [&](V* a) {
        V length = root(dot(a, a)), per = real(1.f) / length;
        for (int k = 0; k < 3; k++) a[k] *= per;
        return length > real(1e-12f);
    };
    auto clamped = [](V x) {
        x = x < real(1.f) ? x : (V)real(1.f);
        return x > real(-1.f) ? x : (V)real(-1.f);
    };
    // Solids of one kind, one for each lane: rows of solids and solid_sizes.
    struct Solids { int kind, number[GROUP]; V own[18], size[3]; };
    auto solids_of = [&](const int* pairs, int side) {
        Solids found;
        bool same = true;
        for (int l = 0; l < GROUP; l++) {
            found.number[l] = program.solid_pairs.data[2 * pairs[l] + side];
            same &= found.number[l] == found.number[0];
        }
        const real* own = program.solids.data + 18 * found.number[0];
        const real* size = program.solid_sizes.data + 3 * found.number[0];
        for (int k = 0; k < 18; k++) found.own[k] = own[k];
        for (int k = 0; k < 3; k++) found.size[k] = size[k];
        found.kind = (int)own[14];
        if (same) return found;
        alignas(256) real rows[21][GROUP];
        for (int l = 0; l < GROUP; l++) {
            own = program.solids.data + 18 * found.number[l];
            size = program.solid_sizes.data + 3 * found.number[l];
            for (int k = 0; k < 18; k++) rows[k][l] = own[k];
            for (int k = 0; k < 3; k++) rows[18 + k][l] = size[k];
        }
        for (int k = 0; k < 18; k++) found.own[k] = *(V*)rows[k];
        for (int k = 0; k < 3; k++) found.size[k] = *(V*)rows[18 + k];
        return found;
    };
    // Farthest points of solids along d, without their balls, in their own frames.
    auto support = [&](const Solids& solid, const V* d, M live, V* o) ONCE {
        const V* size = solid.size;
        if (solid.kind == 3) {
            for (int k = 0; k < 3; k++) o[k] = d[k] > real(0.f) ? size[k] : -size[k];
        } else if (solid.kind == 1) {
            V x = size[0] * d[0], y = size[1] * d[1], z = size[2] * d[2], length = root(x * x + y * y + z * z);
            V per = length > real(1e-12f) ? real(1.f) / length : (V)real(0.f);
            o[0] = size[0] * x * per; o[1] = size[1] * y * per; o[2] = size[2] * z * per;
        } else {
            // Only those vertices that are farthest along some direction near d: see `collision.supports`.
            auto size_of = [](V x) { return x > real(0.f) ? x : -x; };
            V x = size_of(d[0]), y = size_of(d[1]), z = size_of(d[2]);
            M along_x = (x > y) & (x > z), along_y = !along_x & (y > z);
            V axis = along_x ? d[0] : (along_y ? d[1] : d[2]);
            V per = real(0.5f * @EDGE) / (along_x ? x : (along_y ? y : z));
            V cell = along_x ? (V)real(0.f) : (along_y ? (V)real(2.f) : (V)real(4.f));
            cell += axis > real(0.f) ? (V)real(1.f) : (V)real(0.f);
            auto column = [&](V beside) {
                V at = real(0.5f * @EDGE) + per * beside;
                at = at > real(0.f) ? at : (V)real(0.f);
                return whole(at < real(@EDGE - 1) ? at : (V)real(@EDGE - 1));
            };
            cell = cell * real(@EDGE) + column(along_x ? d[1] : (along_y ? d[2] : d[0]));
            cell = cell * real(@EDGE) + column(along_x ? d[2] : (along_y ? d[0] : d[1]));
            alignas(256) real D[3][GROUP], O[3][GROUP], C[GROUP], on[GROUP];
            for (int k = 0; k < 3; k++) { *(V*)D[k] = d[k]; *(V*)O[k] = real(0.f); }
            *(V*)C = cell;
            *(V*)on = live ? (V)real(1.f) : (V)real(0.f);
            int list[GROUP], lanes = 0;
            for (int l = 0; l < GROUP; l++) { list[lanes] = l; lanes += on[l] != 0.f ? 1 : 0; }
            for (int i = 0; i < lanes; i++) {
                const int l = list[i];
                const int* range = program.vertex_range.data + 2 * (@CELLS * solid.number[l] + (int)C[l]);
                const int first = range[0], count = range[1];
                const real* VX = program.vertices.data + first;
                const real* VY = VX + count; const real* VZ = VY + count;
                int best = 0;
#if defined(__CUDA_ARCH__)
                real most = -1e30f;
                for (int v = 0; v < count; v++) {
                    real t = VX[v] * D[0][l] + VY[v] * D[1][l] + VZ[v] * D[2][l];
                    if (t > most) { most = t; best = v; }
                }
#else
                typedef real Row __attribute__((ext_vector_type(@ROW)));
                typedef decltype(Row() > Row()) Places;
                const Places own = {0, 1, 2, 3, 4, 5, 6, 7};
                Row most = real(-1e30f), vx, vy, vz;
                Places which = 0;
                for (int v = 0; v < count; v += @ROW) {
                    __builtin_memcpy(&vx, VX + v, sizeof(vx));
                    __builtin_memcpy(&vy, VY + v, sizeof(vy));
                    __builtin_memcpy(&vz, VZ + v, sizeof(vz));
                    Row t = vx * D[0][l] + vy * D[1][l] + vz * D[2][l];
                    which = t > most ? v + own : which;
                    most = t > most ? t : most;
                }
                best = (int)__builtin_reduce_min(most == __builtin_reduce_max(most) ? which : (Places)(count - 1));
#endif
                O[0][l] = VX[best]; O[1][l] = VY[best]; O[2][l] = VZ[best];
            }
            for (int k = 0; k < 3; k++) o[k] = *(V*)O[k];
        }
        if (any(solid.own[13] > real(0.f))) {
            V h = root(d[0] * d[0] + d[1] * d[1]);
            h = h > real(1e-12f) ? solid.own[13] / h : (V)real(0.f);
            o[0] += h * d[0]; o[1] += h * d[1];
        }
    };
    const V APART = real(0.f), TOUCHING = real(1.f), OPEN = real(2.f);
    // By the farthest points of Minkowski differences, and points v0 in them.
    auto portal_of = [&](auto farthest, const V* v0, M live, V eps) -> V {
        V v1[3], v2[3], v3[3], v4[3], n[3], s[3], t[3];
        V found = OPEN, e;
        auto settle = [&](M where, V as) { found = (live & where) ? as : found; live = live & !where; };
        for (int k = 0; k < 3; k++) n[k] = -v0[k];
        live = live & unit(n);
        farthest(n, live, v1);
        settle(dot(v1, n) < -eps, APART);
        cross(v1, v0, n);
        live = live & unit(n);
        if (!any(live)) return found;
        farthest(n, live, v2);
        settle(dot(v2, n) < -eps, APART);
        for (int k = 0; k < 3; k++) { s[k] = v1[k] - v0[k]; t[k] = v2[k] - v0[k]; v3[k] = v0[k]; }
        cross(s, t, n);
        live = live & unit(n);
        M behind = dot(n, v0) > real(0.f), portal = eps < real(0.f);
        for (int k = 0; k < 3; k++) { s[k] = v1[k]; n[k] = behind ? -n[k] : n[k]; }
        put(v1, behind, v2);
        put(v2, behind, s);
        for (int it = 0; it < @STEPS && any(live); it++) {
            farthest(n, live, v4);
            e = dot(v4, n);
            settle(e < -eps, APART);
            settle(portal & (e - dot(v3, n) < real(@STALLED)), OPEN);
            // A portal is sought, one side after the other, then moved outwards.
            cross(v1, v4, s);
            cross(v4, v2, t);
            M beside_2 = !portal & (dot(s, v0) < real(0.f)), beside_1 = !portal & !beside_2 & (dot(t, v0) < real(0.f));
            cross(v4, v0, s);
            M one = dot(v1, s) > real(0.f), two = dot(v2, s) > real(0.f), three = dot(v3, s) > real(0.f);
            put(v1, beside_1 | (portal & ((one & two) | (!one & !three))), v4);
            put(v2, beside_2 | (portal & !one & three), v4);
            put(v3, (!portal & !beside_1 & !beside_2) | (portal & one & !two), v4);
            portal = portal | (!beside_1 & !beside_2);
            for (int k = 0; k < 3; k++) {
                s[k] = portal ? v2[k] - v1[k] : v1[k] - v0[k];
                t[k] = portal ? v3[k] - v1[k] : v2[k] - v0[k];
            }
            cross(s, t, n);
            live = live & unit(n);
            // All three corners beyond the origin: of a thin portal the normal is known badly.
            V one_way = dot(n, v1), other = dot(n, v2), third = dot(n, v3);
            one_way = one_way < other ? one_way : other;
            settle(portal & ((one_way < third ? one_way : third) > eps), TOUCHING);
        }
        return found;
    };
@TRIANGLES    // Of as many pairs as there are lanes, with frames FA and FB of solids: 0 apart, 1 touching, 2 open.
    auto decided = [&](const int* pairs, V margin, const V* FA, const V* FB, V eps) -> V {
        const Solids a = solids_of(pairs, 0), b = solids_of(pairs, 1);
        const V* of_a = a.own; const V* of_b = b.own;
        const V ball = margin + of_a[12] + of_b[12];
        auto placed = [](const V* S, const V* t, V* R, V* p) {
            for (int r = 0; r < 3; r++) {
                for (int k = 0; k < 3; k++) R[3 * r + k] = S[r] * t[k] + S[3 + r] * t[3 + k] + S[6 + r] * t[6 + k];
                p[r] = S[9 + r] + S[r] * t[9] + S[3 + r] * t[10] + S[6 + r] * t[11];
            }
        };
        V RA[9], pA[3], RB[9], pB[3], R[9], p[3];  // R, p: of b in the frame of a
        placed(FA, of_a, RA, pA); placed(FB, of_b, RB, pB);
@AGAINST        for (int k = 0; k < 3; k++) pB[k] -= pA[k];
        for (int r = 0; r < 3; r++) {
            for (int k = 0; k < 3; k++) R[3 * r + k] = RA[r] * RB[k] + RA[3 + r] * RB[3 + k] + RA[6 + r] * RB[6 + k];
            p[r] = RA[r] * pB[0] + RA[3 + r] * pB[1] + RA[6 + r] * pB[2];
        }
        M live = eps < real(1e29f);
        if (a.kind == 2) {
            V down[3] = {-R[6], -R[7], -R[8]}, lowest[3];
            support(b, down, live, lowest);
            V height = p[2] - dot(lowest, down) - ball;
            return height > eps ? APART : (height < -eps ? TOUCHING : OPEN);
        }
        // Of the Minkowski difference B - A, widened by balls and margin: farthest point along d.
        auto farthest = [&](const V* d, M live, V* o) {
            V x[3], y[3], l[3], m[3];
            for (int k = 0; k < 3; k++) { l[k] = R[k] * d[0] + R[3 + k] * d[1] + R[6 + k] * d[2]; m[k] = -d[k]; }
            support(b, l, live, y);
            support(a, m, live, x);
            for (int k = 0; k < 3; k++) o[k] = p[k] + dot(R + 3 * k, y) - x[k] + ball * d[k];
        };
        // From the nearest points of two segments within them; where these cross, from their middles.
        V v0[3], s[3], u[3], w[3];
        for (int k = 0; k < 3; k++) { u[k] = of_a[15 + k]; s[k] = of_b[15 + k]; }
        for (int k = 0; k < 3; k++) w[k] = dot(R + 3 * k, s);
        V uu = dot(u, u) + real(1e-10f), ww = dot(w, w) + real(1e-10f), uw = dot(u, w), up = dot(u, p), wp = dot(w, p);
        V at_u = clamped((up * ww - wp * uw) / (uu * ww * real(1.000001f) - uw * uw));
        V at_w = clamped((at_u * uw - wp) / ww);
        at_u = clamped((at_w * uw + up) / uu);
        for (int k = 0; k < 3; k++) v0[k] = p[k] + at_w * w[k] - at_u * u[k];
        put(v0, dot(v0, v0) < real(1e-6f), p);
        return portal_of(farthest, v0, live, eps);
    };
    int label_[LN], reason_[LN], anyway_[LN], next_[LN], list[LN], pair_[LN], sorted_[LN];
    unsigned still_[W * LN];
    for (int l = 0; l < valid; l++) {
        label_[l] = next_[l] = 0; reason_[l] = 99; list[l] = l;
        anyway_[l] = labels.data[open_ids.data[item + l]];  // a later reason, where an earlier one is open
    }
    for (int k = 0; k < W * LN; k++) still_[k] = 0u;
    for (int left = valid, count; left; left = count) {
        int starts[GROUP > 1 ? 32 * W + 1 : 1] = {0};
        count = 0;
        for (int i = 0; i < left; i++) {
            const int l = list[i];
            if (label_[l] != 0) continue;
            const unsigned* asked = open_masks.data + (long long)(item + l) * W;
            int w = next_[l] >> 5;
            unsigned bits = w < W ? asked[w] & (~0u << (next_[l] & 31)) : 0u;
            while (!bits && ++w < W) bits = asked[w];
            if (!bits) continue;
            const int pair = 32 * w + LOWEST(bits);
            if (pair >= program.n_solid_pairs) continue;
            if (anyway_[l] != 0 && (int)program.pair_numbers.data[2 * pair + 1] + 1 >= anyway_[l]) continue;
            next_[l] = pair + 1;
            list[count++] = l; pair_[l] = pair;
            if (GROUP > 1) starts[program.pair_ranks.data[pair] + 1]++;
        }
        if (GROUP > 1) {
            for (int k = 0; k < 32 * W; k++) starts[k + 1] += starts[k];
            for (int i = 0; i < count; i++) sorted_[starts[program.pair_ranks.data[pair_[list[i]]]]++] = list[i];
        }
        const int* order = GROUP > 1 ? sorted_ : list;
        for (int start = 0, lanes; start < count; start += lanes) {
            alignas(256) real FA[12][GROUP], FB[12][GROUP], eps[GROUP], margin[GROUP], found[GROUP];
            int pairs[GROUP];
            auto kinds = [&](int at) { return program.pair_kinds.data[pair_[order[at]]]; };
            for (lanes = 1; lanes < GROUP && start + lanes < count && kinds(start + lanes) == kinds(start);) lanes++;
            for (int l = 0; l < GROUP; l++) {
                const int from = order[l < lanes ? start + l : start];
                pairs[l] = pair_[from];
                const int* solids = program.solid_pairs.data + 2 * pairs[l];
                const real* A = F + 12 * program.solid_frame.data[solids[0]] * LN + from;
                const real* B = F + 12 * program.solid_frame.data[solids[1]] * LN + from;
                for (int k = 0; k < 12; k++) { FA[k][l] = A[k * LN]; FB[k][l] = B[k * LN]; }
                margin[l] = program.pair_numbers.data[2 * pairs[l]];
                eps[l] = l < lanes ? eps_[from] : real(1e30f);
            }
            *(V*)found = decided(pairs, *(const V*)margin, (const V*)FA, (const V*)FB, *(const V*)eps);
            for (int l = 0; l < lanes; l++) {
                const int at = order[start + l], reason = (int)program.pair_numbers.data[2 * pairs[l] + 1] + 1;
                if (found[l] == 0.f) continue;
                if (found[l] == 1.f && reason_[at] >= reason) { label_[at] = reason; continue; }
                still_[(pairs[l] >> 5) * LN + at] |= 1u << (pairs[l] & 31);
                reason_[at] = reason_[at] < reason ? reason_[at] : reason;
            }
        }
    }
    for (int l = 0; l < valid; l++) {
        const int at = open_ids.data[item + l];
        if (label_[l] != 0 || reason_[l] == 99) {
            labels.data[at] = (wp::uint8)(label_[l] != 0 ? label_[l] : anyway_[l]);
            continue;
        }
#if defined(__CUDA_ARCH__)
        const int place = atomicAdd(listed.data, 1);
#else
        const int place = listed.data[0]++;
#endif
        ids.data[place] = at;
        otherwise.data[place] = (wp::uint8)anyway_[l];
        for (int w = 0; w < W; w++) masks.data[(long long)place * W + w] = still_[w * LN + l];
    }
    #undef LANE_LOOP
    #undef ONCE
    #undef LOWEST
"""


_TRIGONOMETRY = "    auto sincos_of = [](double a, double& sine, double& cosine) { sine = sin(a); cosine = cos(a); };\n"


_AGAINST = "        if (a.kind == 4) return against_surface(margin, a.number[0], b, FB, RB, pB, eps);\n"


def _code(
    snippet: str,
    n: int,
    joints: int,
    capsules: int,
    words: int,
    body: str = "",
    exact: bool = False,
    surfaces: bool = False,
    crowd: int = 0,
) -> str:
    values = {
        "LOOKUPS\n": LOOKUPS if surfaces else "",
        "CROWD\n": CROWD if crowd else "",
        "CROWD_BALLS": crowd,
        "TRIANGLES ": TRIANGLES + " " if surfaces else " ",
        "AGAINST": _AGAINST if surfaces else "",
        "SURFACES": int(surfaces),
        "GRAZING": 1e-9 if exact else 1e-4,  # sine of an angle between ray and triangle
        "BESIDE": 1e-7 if exact else 1e-2,  # share of a triangle from its edges
        "TRIGONOMETRY": _TRIGONOMETRY if exact else _SINCOS,
        "SINCOS": _SINCOS,
        "KINEMATICS": _KINEMATICS,
        "BODY": body,
        "REAL": "double" if exact else "float",
        "SQRT": "sqrt" if exact else "sqrtf",
        "AT_ONCE": AT_ONCE,
        "SIDE_BY_SIDE": SIDE_BY_SIDE,
        "WITHIN": WITHIN,
        "EDGE": EDGE,
        "CELLS": 6 * EDGE**2,
        "ROW": ROW,
        "STALLED": 1e-12 if exact else 1e-6,  # how much farther a point lies that is no longer farther [m]
        "LANES": PART_LANES,
        "BATCH": BATCH,
        "GROUP": GROUP,
        "TOGETHER": TOGETHER,
        "STEPS": STEPS,
        "BLOCK": LANES,
        "N": n,
        "L": joints,
        "CAP": capsules,
        "W": words,
    }
    for name, value in values.items():
        snippet = snippet.replace(f"@{name}", str(value))
    return snippet


@factory
def filter_kernel(
    real: Any,
    n: int,
    joints: int,
    capsules: int,
    words: int,
    method: str,
    shared: int,
    cuda: bool,
    body: str | None = None,
    surfaces: bool = False,
    crowd: int = 0,
) -> wp.Kernel:
    """Kernel that labels the samples of a chunk and lists what is open; see the module.

    ``capsules``: scratch for so many; ``words``: of a mask of pairs; ``cuda``: a thread takes a sample, not a block;
    ``body``: of one robot, as `collision_unrolled.unrolled` writes it, for such a thread; ``surfaces``: whether there
    are any; ``crowd``: scratch for so many balls of one. Out: ``labels`` (count,),
    ``listed`` (1,) how many are, ``ids`` (count,) their numbers in the chunk, ``open_masks`` (count * words,).
    """
    block_of, draws = blocks(real, n, shared), sampling(real, n, method, shared)
    prepare, draw = draws.prepare, draws.draw
    Space, Program = sample_space(real, n), program_type(wp.float32)
    size = 1 if cuda else LANES
    values_type = wp.types.vector(n * size, wp.float32)
    u8, i32, u32 = (wp.array(dtype=dtype) for dtype in (wp.uint8, wp.int32, wp.uint32))
    BLOCK, LANE_MASK = LANES, wp.int64(LANES - 1)

    snippet = _FILTER if body is None else _UNROLLED
    code = _code(snippet, n, joints, capsules, words, body or "", surfaces=surfaces, crowd=crowd)

    @wp.func_native(code)
    def filtered(
        values: values_type,
        valid: wp.int32,
        offset: wp.int32,
        program: Program,
        labels: u8,
        listed: i32,
        ids: i32,
        open_masks: u32,
    ): ...

    if cuda:

        @wp.kernel(module="unique", module_options=CUDA_OPTIONS, enable_backward=False)
        def filter_cuda(
            # in
            program: Program,
            space: Space,
            first: wp.int64,
            count: wp.int64,
            # out
            labels: u8,
            listed: i32,
            ids: i32,
            open_masks: u32,
        ):
            offset = wp.tid()
            index = first + wp.int64(offset)
            start = index - (index & LANE_MASK)
            drawn = draw(space, prepare(space, start), start, wp.int32(index & LANE_MASK))
            values = values_type()
            for i in range(n):
                values[i] = wp.float32(drawn[i])
            filtered(values, 1, offset, program, labels, listed, ids, open_masks)

        return filter_cuda

    @wp.kernel(module="unique", module_options=SHORT_OPTIONS, enable_backward=False)
    def filter_cpu(
        # in
        program: Program,
        space: Space,
        first: wp.int64,
        count: wp.int64,
        # out
        labels: u8,
        listed: i32,
        ids: i32,
        open_masks: u32,
    ):
        start, valid = block_of(space, first, count, wp.tid())
        block = prepare(space, start)
        values = values_type()
        for lane in range(BLOCK):
            drawn = draw(space, block, start, wp.min(lane, valid - 1))
            for i in range(n):
                values[i * BLOCK + lane] = wp.float32(drawn[i])
        filtered(values, valid, wp.int32(start - first), program, labels, listed, ids, open_masks)

    return filter_cpu


@factory
def narrow_kernel(
    real: Any, n: int, joints: int, words: int, method: str, cuda: bool, exact: bool = False, surfaces: bool = False
) -> wp.Kernel:
    """Kernel that decides listed samples, one thread each; see the module.

    What stays open is listed again: ``ids``, ``masks`` of the pairs that are left, and in ``otherwise`` the label where
    none of those touches. ``exact``: computed in float64; ``surfaces``: whether there are any.
    """
    draws = sampling(real, n, method)
    prepare, draw = draws.prepare, draws.draw
    own_real = wp.float64 if exact else wp.float32
    Space, Program = sample_space(real, n), program_type(own_real)
    size = 1 if cuda else BATCH
    values_type = wp.types.vector(n * size, own_real)
    u8, i32, u32 = (wp.array(dtype=dtype) for dtype in (wp.uint8, wp.int32, wp.uint32))
    LANE_MASK = wp.int64(LANES - 1)

    @wp.func_native(_code(_NARROW, n, joints, 0, words, exact=exact, surfaces=surfaces))
    def decide(
        values: values_type,
        valid: wp.int32,
        item: wp.int32,
        program: Program,
        open_ids: i32,
        open_masks: u32,
        labels: u8,
        listed: i32,
        ids: i32,
        masks: u32,
        otherwise: u8,
    ): ...

    @wp.kernel(module="unique", module_options=CUDA_OPTIONS if cuda else SHORT_OPTIONS, enable_backward=False)
    def narrow(
        # in
        program: Program,
        space: Space,
        first: wp.int64,
        count: wp.int32,
        open_ids: i32,
        open_masks: u32,
        # out
        labels: u8,
        listed: i32,
        ids: i32,
        masks: u32,
        otherwise: u8,
    ):
        item = wp.tid() * size
        valid = wp.min(size, count - item)
        values = values_type()
        for lane in range(size):
            index = first + wp.int64(open_ids[item + wp.min(lane, valid - 1)])
            start = index - (index & LANE_MASK)
            drawn = draw(space, prepare(space, start), start, wp.int32(index & LANE_MASK))
            for i in range(n):
                values[i * size + lane] = own_real(drawn[i])
        decide(values, valid, item, program, open_ids, open_masks, labels, listed, ids, masks, otherwise)

    return narrow


@factory
def put_kernel() -> wp.Kernel:
    """Kernel that puts the labels ``found`` (N,) of samples ``ids`` (N,) that the host has decided."""

    @wp.kernel(module="unique", module_options=MODULE_OPTIONS, enable_backward=False)
    def put(
        # in
        ids: wp.array(dtype=wp.int32),
        found: wp.array(dtype=wp.uint8),
        # out
        labels: wp.array(dtype=wp.uint8),
    ):
        item = wp.tid()
        labels[ids[item]] = found[item]

    return put
