"""Whether the solids of a robot and its surroundings touch: a filter of certified tests, then a narrow phase.

``filter``: on the CPU a task is a block of LANES samples, of which PART_LANES at a time go through loops over joints,
capsules, tests and tables around lane loops, which clang turns into SIMD: the robot is data, and one kernel serves all
with the same numbers of coordinates and joints. On CUDA a thread takes a sample through the same code, of one lane.
It labels a sample ADMITTED or with the number of the reason, from 1; a sample with pairs that no test decides is listed
with a mask of those. ``narrow`` decides listed samples pair by pair: portals of the Minkowski difference (Snethen,
*XenoCollide*, 2008), certified by a gap along a direction or by a portal that the origin lies behind, each by more than
what float32 may be off; what is still open then is listed for the same in float64, and at last for the host.
"""

from typing import Any

import warp as wp

from wsrender_kernels.factories import factory
from wsrender_kernels.options import CUDA_OPTIONS, MODULE_OPTIONS, SHORT_OPTIONS
from wsrender_kernels.sampling import LANES, blocks, sample_space, sampling

PART_LANES = 64
CAPACITY = 16  # capsules: the scratch is for a multiple of so many

REAL_ARRAYS = ("joints", "solids", "solid_sizes", "vertices", "pair_numbers")  # what the narrow phase computes with
_ARRAYS = {
    wp.float32: ("lower", "upper", "capsules", "test_numbers", "table_numbers"),
    wp.int32: ("sources", "capsule_frame", "pairs", "planes", "tests", "tables", "table_columns", "solid_frame",
               "vertex_range", "solid_pairs"),
    wp.uint32: ("table_words", "first_reason"),
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

_FILTER = """
#if defined(__CUDA_ARCH__)
    #define LANE_LOOP for (int l = 0; l < LN; l++)
    constexpr int LN = 1, STRIDE = 1;
#else
    #define LANE_LOOP _Pragma("clang loop vectorize(assume_safety) interleave_count(1)") for (int l = 0; l < LN; l++)
    constexpr int LN = @LANES, STRIDE = @BLOCK;
#endif
    constexpr int N = @N, L = @L, CAP = @CAP, W = @W;
    constexpr float FAR = 1e9f;
@SINCOS
    alignas(64) float frames_[12 * (L + 1) * LN], capsules_[6 * CAP * LN], near_[LN], hit_[2 * LN];
    alignas(64) unsigned masks_[W * LN], inside_[LN];
    float* __restrict F = frames_; float* __restrict C = capsules_; float* __restrict nr = near_;
    unsigned* __restrict masks = masks_; unsigned* __restrict inside = inside_;
    const float* __restrict q = &values.c[0];
    for (int part = 0; part * LN < valid; part++) {
    const float* __restrict Q = q + part * LN;
    for (int l = 0; l < LN; l++) {
        inside[l] = 1u;
        for (int k = 0; k < 12; k++) F[k * LN + l] = (k == 0 || k == 4 || k == 8) ? 1.f : 0.f;
        for (int w = 0; w < W; w++) masks[w * LN + l] = 0u;
        hit_[l] = FAR; hit_[LN + l] = FAR;
    }
    for (int i = 0; i < N; i++) {
        // Tables and proofs hold within the limits alone.
        const float low = program.lower.data[i], high = program.upper.data[i], slack = 4e-6f * (1.f + high - low);
        const float* __restrict v = Q + i * STRIDE;
        LANE_LOOP { float x = v[l]; inside[l] &= (x >= low - slack && x <= high + slack) ? 1u : 0u; }
    }
    for (int i = 0; i < L; i++) {
        const float* t = program.joints.data + 15 * i;
        const float* __restrict S = F + 12 * i * LN; float* __restrict D = F + 12 * (i + 1) * LN;
        const float* __restrict v = Q + program.sources.data[i] * STRIDE;
        const float scale = t[12], offset = t[13], turns = t[14];
        LANE_LOOP {
            float moved = scale * v[l] + offset, angle = turns * moved, slide = moved - angle, s, c;
            sincos_of(angle, s, c);
            for (int k = 0; k < 3; k++) {
                float X = S[k * LN + l], Y = S[(3 + k) * LN + l], Z = S[(6 + k) * LN + l];
                float x = X * t[0] + Y * t[3] + Z * t[6], y = X * t[1] + Y * t[4] + Z * t[7];
                float z = X * t[2] + Y * t[5] + Z * t[8];
                D[k * LN + l] = c * x + s * y;
                D[(3 + k) * LN + l] = c * y - s * x;
                D[(6 + k) * LN + l] = z;
                D[(9 + k) * LN + l] = S[(9 + k) * LN + l] + X * t[9] + Y * t[10] + Z * t[11] + slide * z;
            }
        }
    }
    for (int i = 0; i < program.n_capsules; i++) {
        const float* __restrict S = F + 12 * program.capsule_frame.data[i] * LN; float* __restrict D = C + 6 * i * LN;
        const float* c = program.capsules.data + 6 * i;
        LANE_LOOP for (int k = 0; k < 3; k++) {
            float X = S[k * LN + l], Y = S[(3 + k) * LN + l], Z = S[(6 + k) * LN + l];
            D[k * LN + l] = S[(9 + k) * LN + l] + X * c[0] + Y * c[1] + Z * c[2];
            D[(3 + k) * LN + l] = X * c[3] + Y * c[4] + Z * c[5];
        }
    }
    for (int p = 0; p < program.n_pairs; p++) {
        const int* row = program.pairs.data + 4 * p;
        const int pair = row[0], balls = row[1] + row[2], end = balls + row[3];
        float* __restrict ht = hit_ + (int)program.pair_numbers.data[2 * pair + 1] * LN;
        for (int l = 0; l < LN; l++) nr[l] = FAR;
        for (int i = row[1]; i < balls; i++) {
            const float* __restrict A = C + 6 * program.tests.data[2 * i] * LN;
            const float* __restrict B = C + 6 * program.tests.data[2 * i + 1] * LN;
            const float near2 = program.test_numbers.data[6 * i + 4], hit2 = program.test_numbers.data[6 * i + 5];
            LANE_LOOP {
                float r0 = A[l] - B[l], r1 = A[LN + l] - B[LN + l], r2 = A[2 * LN + l] - B[2 * LN + l];
                float d2 = r0 * r0 + r1 * r1 + r2 * r2, x = d2 - near2, y = d2 - hit2;
                nr[l] = x < nr[l] ? x : nr[l];
                ht[l] = y < ht[l] ? y : ht[l];
            }
        }
        for (int i = balls; i < end; i++) {
            const float* __restrict A = C + 6 * program.tests.data[2 * i] * LN;
            const float* __restrict B = C + 6 * program.tests.data[2 * i + 1] * LN;
            const float* t = program.test_numbers.data + 6 * i;
            const float ia = t[1], e = t[2], ie = t[3], near2 = t[4], hit2 = t[5], ae = t[0] * e * 1.000001f;
            LANE_LOOP {
                float r0 = A[l] - B[l], r1 = A[LN + l] - B[LN + l], r2 = A[2 * LN + l] - B[2 * LN + l];
                float g0 = A[3 * LN + l], g1 = A[4 * LN + l], g2 = A[5 * LN + l];
                float h0 = B[3 * LN + l], h1 = B[4 * LN + l], h2 = B[5 * LN + l];
                float b = g0 * h0 + g1 * h1 + g2 * h2, c = g0 * r0 + g1 * r1 + g2 * r2, f = h0 * r0 + h1 * r1 + h2 * r2;
                float s = (b * f - c * e) / (ae - b * b);
                s = s < 1.f ? s : 1.f; s = s > -1.f ? s : -1.f;
                float w = (b * s + f) * ie;
                w = w < 1.f ? w : 1.f; w = w > -1.f ? w : -1.f;
                s = (b * w - c) * ia;
                s = s < 1.f ? s : 1.f; s = s > -1.f ? s : -1.f;
                r0 += g0 * s - h0 * w; r1 += g1 * s - h1 * w; r2 += g2 * s - h2 * w;
                float d2 = r0 * r0 + r1 * r1 + r2 * r2, x = d2 - near2, y = d2 - hit2;
                nr[l] = x < nr[l] ? x : nr[l];
                ht[l] = y < ht[l] ? y : ht[l];
            }
        }
        unsigned* __restrict mask = masks + (pair >> 5) * LN; const unsigned bit = 1u << (pair & 31);
        LANE_LOOP mask[l] |= nr[l] < 0.f ? bit : 0u;
    }
    for (int p = 0; p < program.n_planes; p++) {
        const int* row = program.planes.data + 3 * p;
        const int pair = row[0];
        float* __restrict ht = hit_ + (int)program.pair_numbers.data[2 * pair + 1] * LN;
        for (int l = 0; l < LN; l++) nr[l] = FAR;
        for (int i = row[1]; i < row[1] + row[2]; i++) {
            const float* __restrict A = C + 6 * program.tests.data[2 * i] * LN;
            const float* __restrict B = C + 6 * program.tests.data[2 * i + 1] * LN;
            const float near1 = program.test_numbers.data[6 * i + 4], hit1 = program.test_numbers.data[6 * i + 5];
            LANE_LOOP {
                float n0 = A[3 * LN + l], n1 = A[4 * LN + l], n2 = A[5 * LN + l];
                float h = (B[l] - A[l]) * n0 + (B[LN + l] - A[LN + l]) * n1 + (B[2 * LN + l] - A[2 * LN + l]) * n2;
                float along = B[3 * LN + l] * n0 + B[4 * LN + l] * n1 + B[5 * LN + l] * n2;
                h -= along > 0.f ? along : -along;
                float x = h - near1, y = h - hit1;
                nr[l] = x < nr[l] ? x : nr[l];
                ht[l] = y < ht[l] ? y : ht[l];
            }
        }
        unsigned* __restrict mask = masks + (pair >> 5) * LN; const unsigned bit = 1u << (pair & 31);
        LANE_LOOP mask[l] |= nr[l] < 0.f ? bit : 0u;
    }
    for (int k = 0; k < program.n_tables; k++) {
        const int* t = program.tables.data + 4 * k; const float* n = program.table_numbers.data + 4 * k;
        const float* __restrict u = Q + t[1] * STRIDE; const float* __restrict v = Q + t[2] * STRIDE;
        const unsigned* __restrict words = program.table_words.data + t[3];
        const int columns = program.table_columns.data[k], pair = t[0];
        const float last_u = (float)(program.columns - 1), last_v = (float)(columns - 1);
        float* __restrict ht = hit_ + (int)program.pair_numbers.data[2 * pair + 1] * LN;
        unsigned* __restrict mask = masks + (pair >> 5) * LN; const unsigned bit = 1u << (pair & 31);
        LANE_LOOP {
            float x = (u[l] - n[0]) * n[1], y = (v[l] - n[2]) * n[3];
            x = x > 0.f ? x : 0.f; x = x < last_u ? x : last_u;
            y = y > 0.f ? y : 0.f; y = y < last_v ? y : last_v;
            int cell = (int)x * columns + (int)y;
            unsigned label = (words[cell >> 4] >> ((cell & 15) * 2)) & 3u;
            mask[l] |= label == 2u ? bit : 0u;
            ht[l] = label == 1u ? -1.f : ht[l];
        }
    }
    for (int l = 0; l < LN; l++) {
        const int lane = part * LN + l;
        if (lane >= valid) break;
        const int at = offset + lane;
        unsigned first = 0u, any = 0u;
        for (int w = 0; w < W; w++) any |= masks[w * LN + l];
        for (int w = 0; w < W; w++) first |= masks[w * LN + l] & program.first_reason.data[w];
        const bool hit_first = hit_[l] < 0.f, hit_second = hit_[LN + l] < 0.f;
        int label = hit_first ? 1 : (hit_second ? 2 : 0);
        bool open = hit_first ? false : (hit_second ? first != 0u : any != 0u);
        if (!inside[l]) { open = true; label = 0; }
        labels.data[at] = (wp::uint8)label;
        if (!open) continue;
#if defined(__CUDA_ARCH__)
        const int place = atomicAdd(listed.data, 1);
#else
        const int place = listed.data[0]++;
#endif
        ids.data[place] = at;
        for (int w = 0; w < W; w++) open_masks.data[(long long)place * W + w] = inside[l] ? masks[w * LN + l] : ~0u;
    }
    }
    #undef LANE_LOOP
"""

_UNROLLED = """
@SINCOS
    auto clamped = [](float x) { return wp::max(wp::min(x, 1.f), -1.f); };
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
@TRIGONOMETRY
    real F[12 * (L + 1)] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};  // rows of the rotation, then the origin
    for (int i = 0; i < L; i++) {
        const real* t = program.joints.data + 15 * i; const real* S = F + 12 * i; real* D = F + 12 * (i + 1);
        real moved = t[12] * q[program.sources.data[i]] + t[13], angle = t[14] * moved, slide = moved - angle, s, c;
        sincos_of(angle, s, c);
        for (int k = 0; k < 3; k++) {
            real X = S[3 * k], Y = S[3 * k + 1], Z = S[3 * k + 2];
            real x = X * t[0] + Y * t[3] + Z * t[6], y = X * t[1] + Y * t[4] + Z * t[7];
            real z = X * t[2] + Y * t[5] + Z * t[8];
            D[3 * k] = c * x + s * y; D[3 * k + 1] = c * y - s * x; D[3 * k + 2] = z;
            D[9 + k] = S[9 + k] + X * t[9] + Y * t[10] + Z * t[11] + slide * z;
        }
    }
    // What float32 may be off is known within the limits alone.
    bool inside = true;
    for (int i = 0; i < N; i++) {
        const float low = program.lower.data[i], high = program.upper.data[i], slack = 4e-6f * (1.f + high - low);
        inside &= q[i] >= low - slack && q[i] <= high + slack;
    }
    const real eps = inside || sizeof(real) == 8 ? program.epsilon : real(1e30);
    auto dot = [](const real* a, const real* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    auto cross = [](const real* a, const real* b, real* o) {
        real x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
        o[0] = x; o[1] = y; o[2] = z;
    };
    auto copy = [](real* a, const real* b) { for (int k = 0; k < 3; k++) a[k] = b[k]; };
    auto unit = [&](real* a) {
        real length = @SQRT(dot(a, a));
        if (!(length > 1e-12f)) return false;
        for (int k = 0; k < 3; k++) a[k] /= length;
        return true;
    };
    auto placed = [&](int solid, real* R, real* p) {
        const real* S = F + 12 * program.solid_frame.data[solid]; const real* t = program.solids.data + 16 * solid;
        for (int r = 0; r < 3; r++) {
            const real* row = S + 3 * r;
            for (int k = 0; k < 3; k++) R[3 * r + k] = row[0] * t[k] + row[1] * t[3 + k] + row[2] * t[6 + k];
            p[r] = S[9 + r] + S[3 * r] * t[9] + S[3 * r + 1] * t[10] + S[3 * r + 2] * t[11];
        }
    };
    // Farthest point of a solid along d.
    auto support = [&](int solid, const real* R, const real* p, real dx, real dy, real dz, real* o) {
        real lx = R[0] * dx + R[3] * dy + R[6] * dz, ly = R[1] * dx + R[4] * dy + R[7] * dz;
        real lz = R[2] * dx + R[5] * dy + R[8] * dz;
        const real* numbers = program.solids.data + 16 * solid;
        real x, y, z;
        if (numbers[14] == 1.f) {
            const real* size = program.solid_sizes.data + 3 * solid;
            real sx = size[0] * lx, sy = size[1] * ly, sz = size[2] * lz, length = @SQRT(sx * sx + sy * sy + sz * sz);
            length = length > 1e-12f ? 1.f / length : 0.f;
            x = size[0] * sx * length; y = size[1] * sy * length; z = size[2] * sz * length;
        } else {
            const int first = program.vertex_range.data[2 * solid], count = program.vertex_range.data[2 * solid + 1];
            const real* VX = program.vertices.data + first; const real* VY = VX + count; const real* VZ = VY + count;
            int best = 0;
#if defined(__CUDA_ARCH__)
            real most = -1e30f;
            for (int v = 0; v < count; v++) {
                real t = VX[v] * lx + VY[v] * ly + VZ[v] * lz;
                if (t > most) { most = t; best = v; }
            }
#else
            real highest[16]; int which[16];
            for (int l = 0; l < 16; l++) { highest[l] = -1e30f; which[l] = 0; }
            for (int v = 0; v < count; v += 16) {
                #pragma clang loop vectorize(assume_safety)
                for (int l = 0; l < 16; l++) {
                    real t = VX[v + l] * lx + VY[v + l] * ly + VZ[v + l] * lz;
                    bool higher = t > highest[l];
                    highest[l] = higher ? t : highest[l]; which[l] = higher ? v + l : which[l];
                }
            }
            real most = -1e30f;
            for (int l = 0; l < 16; l++) if (highest[l] > most) { most = highest[l]; best = which[l]; }
#endif
            x = VX[best]; y = VY[best]; z = VZ[best];
        }
        const real radius = numbers[12], disc = numbers[13];
        if (disc > 0.f) {
            real h = @SQRT(lx * lx + ly * ly);
            if (h > 1e-12f) { x += disc * lx / h; y += disc * ly / h; }
        }
        if (radius > 0.f) {
            real h = @SQRT(lx * lx + ly * ly + lz * lz);
            if (h > 1e-12f) { x += radius * lx / h; y += radius * ly / h; z += radius * lz / h; }
        }
        o[0] = R[0] * x + R[1] * y + R[2] * z + p[0];
        o[1] = R[3] * x + R[4] * y + R[5] * z + p[1];
        o[2] = R[6] * x + R[7] * y + R[8] * z + p[2];
    };
    // 0 apart, 1 touching, 2 open.
    auto decided = [&](int pair) -> int {
        const int a = program.solid_pairs.data[2 * pair], b = program.solid_pairs.data[2 * pair + 1];
        const real margin = program.pair_numbers.data[2 * pair];
        real RA[9], pA[3], RB[9], pB[3];
        placed(a, RA, pA); placed(b, RB, pB);
        if (program.solids.data[16 * a + 14] == 2.f) {
            real n[3] = {RA[2], RA[5], RA[8]}, lowest[3];
            support(b, RB, pB, -n[0], -n[1], -n[2], lowest);
            for (int k = 0; k < 3; k++) lowest[k] -= pA[k];
            real height = dot(lowest, n) - margin;
            return height > eps ? 0 : (height < -eps ? 1 : 2);
        }
        // Of the Minkowski difference B - A, widened by the margin: farthest point along d.
        auto farthest = [&](const real* d, real* o) {
            real x[3], y[3];
            support(b, RB, pB, d[0], d[1], d[2], y);
            support(a, RA, pA, -d[0], -d[1], -d[2], x);
            for (int k = 0; k < 3; k++) o[k] = y[k] - x[k] + margin * d[k];
        };
        real v0[3], v1[3], v2[3], v3[3], v4[3], n[3], t1[3], t2[3], e;
        for (int k = 0; k < 3; k++) { v0[k] = pB[k] - pA[k]; n[k] = -v0[k]; }
        if (!unit(n)) return 2;
        farthest(n, v1); e = dot(v1, n); if (e < -eps) return 0;
        cross(v1, v0, n); if (!unit(n)) return 2;
        farthest(n, v2); e = dot(v2, n); if (e < -eps) return 0;
        for (int k = 0; k < 3; k++) { t1[k] = v1[k] - v0[k]; t2[k] = v2[k] - v0[k]; }
        cross(t1, t2, n); if (!unit(n)) return 2;
        if (dot(n, v0) > 0.f) { copy(t1, v1); copy(v1, v2); copy(v2, t1); for (int k = 0; k < 3; k++) n[k] = -n[k]; }
        int it = 0;
        for (; it < 20; it++) {
            farthest(n, v3); e = dot(v3, n); if (e < -eps) return 0;
            cross(v1, v3, t1);
            if (dot(t1, v0) < 0.f) {
                copy(v2, v3);
                for (int k = 0; k < 3; k++) { t1[k] = v1[k] - v0[k]; t2[k] = v3[k] - v0[k]; }
                cross(t1, t2, n); if (!unit(n)) return 2;
                continue;
            }
            cross(v3, v2, t1);
            if (dot(t1, v0) < 0.f) {
                copy(v1, v3);
                for (int k = 0; k < 3; k++) { t1[k] = v3[k] - v0[k]; t2[k] = v2[k] - v0[k]; }
                cross(t1, t2, n); if (!unit(n)) return 2;
                continue;
            }
            break;
        }
        if (it == 20) return 2;
        for (it = 0; it < 40; it++) {
            for (int k = 0; k < 3; k++) { t1[k] = v2[k] - v1[k]; t2[k] = v3[k] - v1[k]; }
            cross(t1, t2, n); if (!unit(n)) return 2;
            // All three corners beyond the origin: of a thin portal the normal is known badly.
            if (wp::min(wp::min(dot(n, v1), dot(n, v2)), dot(n, v3)) > eps) return 1;
            farthest(n, v4); e = dot(v4, n); if (e < -eps) return 0;
            if (e - dot(v3, n) < real(@STALLED)) return 2;
            cross(v4, v0, t1);
            if (dot(v1, t1) > 0.f) { if (dot(v2, t1) > 0.f) copy(v1, v4); else copy(v3, v4); }
            else { if (dot(v3, t1) > 0.f) copy(v2, v4); else copy(v1, v4); }
        }
        return 2;
    };
    const int hit_anyway = labels.data[at];  // a later reason, where an earlier one is open
    int label = 0, open_reason = 99;
    unsigned still[W] = {0u};
    for (int w = 0; w < W && label == 0; w++) {
        unsigned mask = open_masks.data[(long long)item * W + w], left = 0u;
        for (int bit = 0; bit < 32 && mask >> bit; bit++) {
            const int pair = 32 * w + bit;
            if (!((mask >> bit) & 1u) || pair >= program.n_solid_pairs) continue;
            const int reason = (int)program.pair_numbers.data[2 * pair + 1] + 1;
            if (hit_anyway != 0 && reason >= hit_anyway) continue;
            const int found = decided(pair);
            if (found == 1 && open_reason >= reason) { label = reason; break; }
            if (found == 0) continue;
            left |= 1u << bit;
            open_reason = open_reason < reason ? open_reason : reason;
        }
        still[w] = left;
    }
    if (label != 0 || open_reason == 99) {
        labels.data[at] = (wp::uint8)(label != 0 ? label : hit_anyway);
        return;
    }
#if defined(__CUDA_ARCH__)
    const int place = atomicAdd(listed.data, 1);
#else
    const int place = listed.data[0]++;
#endif
    ids.data[place] = at;
    otherwise.data[place] = (wp::uint8)hit_anyway;
    for (int w = 0; w < W; w++) masks.data[(long long)place * W + w] = still[w];
"""


_TRIGONOMETRY = "    auto sincos_of = [](double a, double& sine, double& cosine) { sine = sin(a); cosine = cos(a); };\n"


def _code(snippet: str, n: int, joints: int, capsules: int, words: int, body: str = "", exact: bool = False) -> str:
    values = {
        "TRIGONOMETRY": _TRIGONOMETRY if exact else _SINCOS,
        "SINCOS": _SINCOS,
        "BODY": body,
        "REAL": "double" if exact else "float",
        "SQRT": "sqrt" if exact else "sqrtf",
        "STALLED": 1e-12 if exact else 1e-6,  # how much farther a point lies that is no longer farther [m]
        "LANES": PART_LANES,
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
) -> wp.Kernel:
    """Kernel that labels the samples of a chunk and lists what is open; see the module.

    ``capsules``: scratch for so many; ``words``: of a mask of pairs; ``cuda``: a thread takes a sample, not a block;
    ``body``: of one robot, as `collision_unrolled.unrolled` writes it, for such a thread. Out: ``labels`` (count,),
    ``listed`` (1,) how many are, ``ids`` (count,) their numbers in the chunk, ``open_masks`` (count * words,).
    """
    block_of, draws = blocks(real, n, shared), sampling(real, n, method, shared)
    prepare, draw = draws.prepare, draws.draw
    Space, Program = sample_space(real, n), program_type(wp.float32)
    size = 1 if cuda else LANES
    values_type = wp.types.vector(n * size, wp.float32)
    u8, i32, u32 = (wp.array(dtype=dtype) for dtype in (wp.uint8, wp.int32, wp.uint32))
    BLOCK, LANE_MASK = LANES, wp.int64(LANES - 1)

    code = _code(_FILTER if body is None else _UNROLLED, n, joints, capsules, words, body or "")

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
    real: Any, n: int, joints: int, words: int, method: str, cuda: bool, exact: bool = False
) -> wp.Kernel:
    """Kernel that decides listed samples, one thread each; see the module.

    What stays open is listed again: ``ids``, ``masks`` of the pairs that are left, and in ``otherwise`` the label where
    none of those touches. ``exact``: computed in float64.
    """
    draws = sampling(real, n, method)
    prepare, draw = draws.prepare, draws.draw
    own_real = wp.float64 if exact else wp.float32
    Space, Program = sample_space(real, n), program_type(own_real)
    vec_n = wp.types.vector(n, own_real)
    u8, i32, u32 = (wp.array(dtype=dtype) for dtype in (wp.uint8, wp.int32, wp.uint32))
    LANE_MASK = wp.int64(LANES - 1)

    @wp.func_native(_code(_NARROW, n, joints, 0, words, exact=exact))
    def decide(
        q: vec_n,
        item: wp.int32,
        at: wp.int32,
        program: Program,
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
        open_ids: i32,
        open_masks: u32,
        # out
        labels: u8,
        listed: i32,
        ids: i32,
        masks: u32,
        otherwise: u8,
    ):
        item = wp.tid()
        at = open_ids[item]
        index = first + wp.int64(at)
        start = index - (index & LANE_MASK)
        drawn = draw(space, prepare(space, start), start, wp.int32(index & LANE_MASK))
        q = vec_n()
        for i in range(n):
            q[i] = own_real(drawn[i])
        decide(q, item, at, program, open_masks, labels, listed, ids, masks, otherwise)

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
