"""Which poses an arm of seven joints reaches: a search along the one at one of its ends, in balls.

Where that joint stands at x, the others are a closed form of `wsrender_kernels.closed_form`: joint 3 by an equation
that holds it alone, then joint 1, then joint 2, then an orthogonal wrist. A ball is all x within w of a centre. At the
centre every branch has a posture, roots that do not exist put at the nearest that does; anywhere in the ball each joint
stands elsewhere by no more than a bound. A posture at the centre within the limits reaches the pose. Where in every
branch a joint is beyond its limits by more than its bound, or a root exists nowhere, no posture is in the ball: it is
closed, else halved. Bounds hold for poses that differ from the target by no more than ``near`` as well: none of them is
reached where all balls are closed.

The wrist's centre p turns about the free axis: its first two derivatives by x, by Taylor's formula, bound how far its
height, distance and direction are off, hence the cosines of joints 3 and 1, and they, since the arc cosine is
monotonic, the joints. Along a slide the centre moves evenly, and nothing turns. The motion S of link 3 against the
target, at most what x and joints 1 to 3 turn in sum, bounds joint 5; joints 4 and 6, at an angle of whose axes the sine
is s, move by no more than asin(S / s).
"""

from dataclasses import dataclass
from itertools import product

import warp as wp

from wsrender_kernels.closed_form import (
    FIELDS,
    closed_form_prelude,
    quaternion_rows,
    rows_of_pose,
    target_in_frame,
    wrist_postures,
)
from wsrender_kernels.factories import factory
from wsrender_kernels.options import CUDA_OPTIONS, LONG_OPTIONS

BALL_LANES = 16  # of a task of the CPU, which fills them again as poses are decided; on CUDA a thread takes one pose
ROOTS = 8  # balls that a search begins with, and one more for every further arc
ARCS = 4  # of the free joint, at most, in which joint 3 has a root within its limits
REACHED, UNREACHABLE, UNDECIDED = 1, -1, 0  # states

# Numbers of an arm beyond FIELDS, whose ``base`` is the free axis's frame. ``link``: from there to the frame of axis 1;
# ``turn``: what an equation's value changes by with (x, y) in the free frame, and its length, of a hinge.
FREE_FIELDS = (
    *FIELDS,
    *(f"link{k}" for k in range(12)),
    *(f"turn{k}_{name}" for k in (1, 2) for name in ("x", "y", "size")),
    *("right1_low", "right1_high"),  # of what equation 1's right side is within joint 3's limits
    "half",  # of the free joint's range, which 0 is the middle of [rad]
    *("right2_size", "f_size"),  # how far equation 2's right side and the centre before joint 2 are moved by joint 3
    *("origin0", "origin1", "origin2", "scale"),  # where the chain's world begins [m], and 1 / reach
    *("near", "near_by", "near_turn"),  # a pose's centre is off by near + near_by times its distance, and turned
)


@dataclass(frozen=True)
class FreeJointShape:
    """The compile-time part: whether each of the two equations holds squares, and the arm is solved from its tip.

    ``slide``: whether the free joint is one; then it is in reaches where else in radians.

    ``quaternions``: whether pose p is a position, ``poses`` (3 * P,) [m], and a quaternion, w first, of any length but
    0, ``tips`` (4 * P,).
    """

    real: type
    squares: tuple[int, int]
    backwards: bool
    quaternions: bool = False
    slide: bool = False


@factory
def free_joint_kernel(shape: FreeJointShape, cuda: bool) -> wp.Kernel:
    """Kernel of a class.

    In: ``count`` poses, ``each`` of a task, the ``most`` balls of a pose, how many ``after`` one is left undecided,
    below what width they are not halved [rad], ``numbers`` of the arm (FREE_FIELDS), and ``which`` (count,): pose p is
    the product of the matrices, by rows, p // K of ``poses`` (16 * P,), in the world, and p % K of ``tips`` (16 * K,).
    Out, (P * K,) each, of those: ``state``; ``at``, the free joint from the middle of its range [rad] at the best
    posture found; ``balls``, added to.
    """
    real = shape.real
    reals, integers = wp.array(dtype=real), wp.array(dtype=wp.int32)

    @wp.func_native(body(shape))
    def block(
        task: wp.int32,
        count: wp.int32,
        each: wp.int32,
        most: wp.int32,
        after: wp.int32,
        narrow: real,
        numbers: reals,
        poses: reals,
        tips: reals,
        which: integers,
        state: integers,
        at: reals,
        balls: integers,
    ): ...

    @wp.kernel(module="unique", module_options=CUDA_OPTIONS if cuda else LONG_OPTIONS, enable_backward=False)
    def free_joint(
        # in
        count: wp.int32,
        each: wp.int32,
        most: wp.int32,
        after: wp.int32,
        narrow: real,
        numbers: wp.array(dtype=real),
        poses: wp.array(dtype=real),
        tips: wp.array(dtype=real),
        which: wp.array(dtype=wp.int32),
        # out
        state: wp.array(dtype=wp.int32),
        at: wp.array(dtype=real),
        balls: wp.array(dtype=wp.int32),
    ):
        block(wp.tid(), count, each, most, after, narrow, numbers, poses, tips, which, state, at, balls)

    return free_joint


def body(shape: FreeJointShape) -> str:
    """C++ of one task."""
    return f"""
    #ifdef __CUDA_ARCH__
    constexpr int lanes = 1;
    #else
    constexpr int lanes = {BALL_LANES};
    #endif
    {lanes_of(shape)}
    {_SEARCH}
    {begin_of(shape)}
    const int last = SMALLER((task + 1) * each, count);
    int next = task * each, busy = 0;
    for (int lane = 0; lane < lanes; lane++) {{
        x[lane] = w[lane] = off[lane] = size[lane] = radius[lane] = ZERO;
        for (int k = 0; k < 9; k++) c[k][lane] = ZERO;
        search[lane].pose = -1;
    }}
    for (;;) {{
        for (int lane = 0; lane < lanes; lane++) {{
            while (search[lane].pose < 0 && next < last) begin(lane, which.data[next++]);
        }}
        busy = 0;
        for (int lane = 0; lane < lanes; lane++) busy += search[lane].pose >= 0;
        if (!busy) break;
        #ifndef __CUDA_ARCH__
        #pragma clang loop vectorize(assume_safety) interleave_count(1)
        #endif
        for (int lane = 0; lane < lanes; lane++) {{
            {ball_of(shape)}
        }}
        for (int lane = 0; lane < lanes; lane++) if (search[lane].pose >= 0) advance(lane);
    }}
    """


def lanes_of(shape: FreeJointShape) -> str:
    """What lanes hold, of which there are ``lanes``: the arm's numbers, poses, balls, and where these are."""
    own = FREE_FIELDS[len(FIELDS) :]
    names = "\n".join(f"const real {name} = numbers.data[{len(FIELDS) + k}];" for k, name in enumerate(own))
    return f"""
    {closed_form_prelude(shape.real)}
    {names}
    const real sq1 = {shape.squares[0]}, sq2 = {shape.squares[1]};
    const real HALF = real(0.5), BIG = 8, TURN = real(6.283185307179586);
    real c[9][lanes], x[lanes], w[lanes], off[lanes], size[lanes], radius[lanes], best[lanes], bound[lanes];
    {_PLACES}
    """


def begin_of(shape: FreeJointShape) -> str:
    """What makes a pose a lane's, or calls ``finish`` where that decides it."""
    rows = (_quaternion_rows if shape.quaternions else pose_rows)(shape.backwards)
    target = target_in_frame(["// with the rows of the pose"])
    many = "const int many = tips.shape[0] / 16;"
    parts = {"ROWS_OF_POSE": "\n".join(rows), "TARGET": target, "NEAR1": _NEAR1}
    parts |= {"ARCS": _SLIDE_ARCS, "FAR": "half"} if shape.slide else {"ARCS": _HINGE_ARCS, "FAR": "ZERO"}
    return many + _with(_BEGIN, parts)


def ball_of(shape: FreeJointShape) -> str:
    """All postures at the centre of a lane's ball, the largest of their slacks, and the bound of slacks in the ball."""
    return _with(_BALL, _SLIDE if shape.slide else _HINGE)


def _with(text: str, parts: dict[str, str]) -> str:
    for name, part in parts.items():
        text = text.replace(name, part)
    return text


def pose_rows(backwards: bool) -> list[str]:
    """A pose as the arm is solved for it, from its tip the inverse: rotation by rows, then position [reach]."""
    rows = ["const real *a = poses.data + 16 * (pose / many), *b = tips.data + 16 * (pose % many);"]
    entries = [" + ".join(f"a[{4 * r + k}] * b[{4 * k + c}]" for k in range(3)) for r, c in product(range(3), range(4))]
    position = [f"{entries[4 * r + 3]} + a[{4 * r + 3}]" for r in range(3)]
    return rows + rows_of_pose([entries[4 * r + c] for r, c in product(range(3), range(3))], position, backwards)


def _quaternion_rows(backwards: bool) -> list[str]:
    """As `pose_rows`, of a position and a quaternion."""
    turn, rotation = quaternion_rows("tips.data", "pose")
    return [*turn, *rows_of_pose(rotation, [f"poses.data[3 * pose + {r}]" for r in range(3)], backwards)]


# What is known of a lane's pose, and the ball that comes next. Halves of a root are numbered by depth and path, whose
# bit k is the side taken k levels above.
_PLACES = f"""
    struct Search {{
        int pose, arcs, roots, number, depth, balls, until;
        int pieces[{ARCS}];
        unsigned open, path;
        real start[{ARCS}], half[{ARCS}], root_x, root_w, most, at;
        bool halving, doubt;
    }};
    Search search[lanes];
    auto place = [&](int lane) {{
        Search& s = search[lane];
        const real width = s.root_w / (real)(1u << s.depth);
        x[lane] = s.root_x - s.root_w + width * (real)(2u * s.path + 1u);
        w[lane] = width * real(1.0000001);
    }};
    // Roots come in an order that does not begin with neighbours.
    auto root = [&](int lane, int number) {{
        Search& s = search[lane];
        int piece = (number * (s.roots % 5 ? 5 : 3) + s.roots / 2) % s.roots, arc = 0;
        while (arc + 1 < s.arcs && piece >= s.pieces[arc]) piece -= s.pieces[arc++];
        s.number = number, s.depth = 0, s.path = 0;
        s.root_w = s.half[arc] / s.pieces[arc];
        s.root_x = s.start[arc] + s.root_w * (2 * piece + 1);
        place(lane);
    }};
    auto deal = [&](Search& s) {{
        real whole = ZERO;
        for (int k = 0; k < s.arcs; k++) whole += s.half[k];
        for (int k = 0; k < s.arcs; k++) {{
            s.pieces[k] = LARGER((int)({ROOTS} * s.half[k] / whole + real(0.999)), 1);
            s.roots += s.pieces[k];
        }}
    }};
"""

_SEARCH = f"""
    auto finish = [&](int lane, int found) {{
        Search& s = search[lane];
        state.data[s.pose] = found, at.data[s.pose] = s.at, balls.data[s.pose] += s.balls;
        s.pose = -1;
    }};
    auto halve = [&](int lane) {{
        Search& s = search[lane];
        s.depth++, s.path <<= 1;
        place(lane);
    }};
    auto next_root = [&](int lane) {{
        Search& s = search[lane];
        int number = s.halving ? s.number + 1 : 0;
        s.halving = true;
        while (number < s.roots && !(s.open >> number & 1)) number++;
        if (number == s.roots) {{
            finish(lane, s.doubt ? {UNDECIDED} : {UNREACHABLE});
            return;
        }}
        root(lane, number);
        halve(lane);
    }};
    auto advance = [&](int lane) {{
        Search& s = search[lane];
        s.balls++;
        if (best[lane] > s.most) s.most = best[lane], s.at = x[lane];
        if (s.most > margin) {{ finish(lane, {REACHED}); return; }}
        const bool closed = bound[lane] < -margin;
        const bool small = !closed && (bound[lane] <= margin || w[lane] < narrow);
        if (small && !s.doubt) s.doubt = true, s.until = s.balls + after;
        if (!s.halving) {{
            if (!closed && !small) s.open |= 1u << s.number;
            if (s.number + 1 < s.roots) root(lane, s.number + 1); else next_root(lane);
        }} else if (!closed && !small) halve(lane);
        else {{
            while (s.depth && (s.path & 1)) s.path >>= 1, s.depth--;
            if (s.depth) {{ s.path |= 1; place(lane); }} else next_root(lane);
        }}
        if (s.pose >= 0 && (s.balls >= most || (s.doubt && s.balls >= s.until))) finish(lane, {UNDECIDED});
    }};
"""

_BEGIN = f"""
    auto arc = [&](Search& s, real low, real high) {{
        low = LARGER(low, -half), high = SMALLER(high, half);
        if (!(high <= low) && s.arcs < {ARCS}) s.start[s.arcs] = low, s.half[s.arcs++] = HALF * (high - low);
    }};
    auto begin = [&](int lane, int pose) {{
        Search& s = search[lane];
        s = Search();
        s.pose = pose, s.most = -4;
        ROWS_OF_POSE
        // The wrist's centre alone first: most poses that are out of reach have no arc.
        const real at0 = t0 * tool9 + t1 * tool10 + t2 * tool11 + t9;
        const real at1 = t3 * tool9 + t4 * tool10 + t5 * tool11 + t10;
        const real at2 = t6 * tool9 + t7 * tool10 + t8 * tool11 + t11;
        const real fx = base0 * at0 + base1 * at1 + base2 * at2 + base9;
        const real fy = base3 * at0 + base4 * at1 + base5 * at2 + base10;
        const real fz = base6 * at0 + base7 * at1 + base8 * at2 + base11;
        const real sized = wp::sqrt(fx * fx + fy * fy + fz * fz);
        if (!(sized < real(1e6))) {{ finish(lane, {UNDECIDED}); return; }}
        radius[lane] = wp::sqrt(fx * fx + fy * fy);
        off[lane] = near + near_by * sized;
        size[lane] = sized + FAR + wp::sqrt(link9 * link9 + link10 * link10 + link11 * link11);
        const real px = link0 * fx + link1 * fy + link2 * fz + link9;
        const real py = link3 * fx + link4 * fy + link5 * fz + link10;
        const real pz = link6 * fx + link7 * fy + link8 * fz + link11;
        const real slack = NEAR1 + real(1e-9);
        ARCS
        deal(s);
        if (!s.arcs) {{ finish(lane, {UNREACHABLE}); return; }}
        {{
            TARGET
            c[0][lane] = A00, c[1][lane] = A10, c[2][lane] = A20, c[3][lane] = A02, c[4][lane] = A12, c[5][lane] = A22;
        }}
        c[6][lane] = fx, c[7][lane] = fy, c[8][lane] = fz;
        root(lane, 0);
    }};
"""

_NEAR1 = "off[lane] * (sq1 * (2 * size[lane] + off[lane]) + SIZE(e1_lz))"

# Where equation 1's value is among what joint 3 may make of it.
_HINGE_ARCS = """
        // It is middle + swing cos(x - phase).
        const real along = turn1_x * fx + turn1_y * fy, swing = turn1_size * radius[lane];
        const real middle = sq1 * (px * px + py * py + pz * pz) + e1_lz * pz + e1_l0 - along;
        const real low = (right1_low - slack - middle) / swing, high = (right1_high + slack - middle) / swing;
        if (!(swing > real(1e-9))) {
            if (!(middle + swing < right1_low - slack || middle - swing > right1_high + slack)) arc(s, -half, half);
        } else if (!(low > ONE || high < -ONE)) {
            const real phase = wp::atan2(turn1_x * fy - turn1_y * fx, along);
            const real inner = high < ONE ? wp::acos(high) : ZERO, outer = low > -ONE ? wp::acos(low) : HALF * TURN;
            for (int k = -1; k < 2; k++) {
                const real at = phase + k * TURN;
                if (inner > ZERO) { arc(s, at - outer, at - inner); arc(s, at + inner, at + outer); }
                else arc(s, at - outer, at + outer);
            }
        }
"""

_SLIDE_ARCS = """
        // It is sq1 x² + slope x + rest.
        const real slope = -(2 * sq1 * (px * link2 + py * link5 + pz * link8) + e1_lz * link8);
        const real rest = sq1 * (px * px + py * py + pz * pz) + e1_lz * pz + e1_l0;
        const real low = right1_low - slack - rest, high = right1_high + slack - rest;
        if (sq1 > ZERO) {
            const real at = -HALF * slope, outer = wp::sqrt(high + at * at), inner = ROOT(low + at * at);
            if (inner > ZERO) { arc(s, at - outer, at - inner); arc(s, at + inner, at + outer); }
            else if (high + at * at > ZERO) arc(s, at - outer, at + outer);
        } else if (SIZE(slope) > real(1e-9)) {
            arc(s, SMALLER(low / slope, high / slope), LARGER(low / slope, high / slope));
        } else if (!(SIZE(slope) * half < low || -SIZE(slope) * half > high)) arc(s, -half, half);
"""

_WRIST = """
                    const real slack5 = hinge(5, c5, s5, n_);
                    const real slack46 = SMALLER(hinge(4, c4, s4, n_), hinge(6, c6, s6, n_));
                    most = LARGER(most, SMALLER(there, SMALLER(slack5, slack46)));
                    const real sine = S * wp::sqrt(i46);  // asin(z) <= z + 0.571 z³
                    const real d46 = sine < ONE ? sine * (ONE + real(0.571) * sine * sine) : BIG;
                    const real joints = SMALLER(may, SMALLER(slack5 + S, slack46 + d46));
                    within = LARGER(within, somewhere < real(-1e-9) ? -ONE : joints);
"""

_BALL = """
            const real wide = w[lane];
            real g0 = c[0][lane], g1 = c[1][lane], g2 = c[2][lane], h0 = c[3][lane], h1 = c[4][lane], h2 = c[5][lane];
            real qx = c[6][lane], qy = c[7][lane], qz = c[8][lane];
            PLACED
            const real A00 = link0 * g0 + link1 * g1 + link2 * g2, A10 = link3 * g0 + link4 * g1 + link5 * g2;
            const real A20 = link6 * g0 + link7 * g1 + link8 * g2;
            const real A02 = link0 * h0 + link1 * h1 + link2 * h2, A12 = link3 * h0 + link4 * h1 + link5 * h2;
            const real A22 = link6 * h0 + link7 * h1 + link8 * h2;
            const real px = link0 * qx + link1 * qy + link2 * qz + link9;
            const real py = link3 * qx + link4 * qy + link5 * qz + link10;
            const real pz = link6 * qx + link7 * qy + link8 * qz + link11;
            // The centre's derivative by x, and what its second one and a pose nearby may add.
            const real tx = MOVED(0, 1, 2), ty = MOVED(3, 4, 5), tz = MOVED(6, 7, 8);
            const real nearby = off[lane], far = FAR, bent = far + nearby;
            const real around = px * px + py * py, r = wp::sqrt(LARGER(around, TINY)), ir = ONE / r;
            const real outward = SIZE(px * tx + py * ty) * ir * wide + bent;
            const real aside = SIZE(px * ty - py * tx) * ir * wide + bent;
            const real r_off = outward + HALF * aside * aside * ir, pz_off = SIZE(tz) * wide + bent;
            #define OVER(a, b) ((b) > ZERO ? SMALLER((a) / (b), BIG) : BIG)
            const real azimuth_off = OVER(aside, r - outward);
            // Between the angles of two points of a circle, or more.
            #define BETWEEN(c_, s_) ((c_) > ZERO ? 2 * SIZE(s_) / (ONE + (c_)) : BIG)
            #define COSINE(a) SMALLER(LARGER(a, -ONE), ONE)
            const real squared = around + pz * pz;
            const real near1 = nearby * (sq1 * (2 * size[lane] + nearby) + SIZE(e1_lz));
            const real near2 = nearby * (sq2 * (2 * size[lane] + nearby) + SIZE(e2_lz));
            const real value1 = sq1 * squared + e1_lz * pz + e1_l0, value2 = sq2 * squared + e2_lz * pz + e2_l0;
            const real value1_off = VALUE_OFF(1) + near1, value2_off = VALUE_OFF(2) + near2;
            const real at3 = value1 * e1_right_scale, off3 = value1_off * e1_right_scale, k3 = COSINE(at3);
            const real half3 = ROOT(ONE - k3 * k3), low3 = COSINE(at3 - off3), high3 = COSINE(at3 + off3);
            const real half_low3 = ROOT(ONE - low3 * low3), half_high3 = ROOT(ONE - high3 * high3);
            const real to_low3 = BETWEEN(k3 * low3 + half3 * half_low3, half3 * low3 - half_low3 * k3);
            const real to_high3 = BETWEEN(k3 * high3 + half3 * half_high3, half3 * high3 - half_high3 * k3);
            const real d3 = LARGER(to_low3, to_high3), bend3 = HALF * d3 * d3;
            const real somewhere3 = ONE + off3 - SIZE(at3), exists3 = (ONE - at3 * at3) * e1_right_weight;
            int n_ = 0;
            real most = -4, within = -4;
            #pragma unroll
            for (int b_three = 0; b_three < 2; b_three++) {
                const real side3 = b_three ? -half3 : half3;
                const real c3 = k3 * e1_right_x - side3 * e1_right_y, s3 = k3 * e1_right_y + side3 * e1_right_x;
                const real right2_off = SIZE(e2_rs * c3 - e2_rc * s3) * d3 + right2_size * bend3;
                const real at1 = (e2_rc * c3 + e2_rs * s3 - value2) * e2_left_scale;
                const real off1 = (SMALLER(right2_off, 2 * right2_size) + value2_off) * e2_left_scale;
                const real up = at1 + off1, down = at1 - off1, near_r = r - r_off, far_r = r + r_off;
                const real k1 = COSINE(at1 * ir), half1 = ROOT(ONE - k1 * k1);
                const bool around1 = near_r > ZERO;
                const real i_near = ONE / (around1 ? near_r : r), i_far = ONE / far_r;
                const real most1_ = up * (up > ZERO ? i_near : i_far), least1_ = down * (down < ZERO ? i_near : i_far);
                const real low1 = COSINE(least1_), high1 = COSINE(most1_);
                const real half_low1 = ROOT(ONE - low1 * low1), half_high1 = ROOT(ONE - high1 * high1);
                const real to_low1 = BETWEEN(k1 * low1 + half1 * half_low1, half1 * low1 - half_low1 * k1);
                const real to_high1 = BETWEEN(k1 * high1 + half1 * half_high1, half1 * high1 - half_high1 * k1);
                const real turned1 = around1 ? LARGER(to_low1, to_high1) : BIG;
                const real somewhere1 = around1 ? ONE - LARGER(least1_, -most1_) : ONE;
                const real somewhere = SMALLER(somewhere3, somewhere1);
                const real exists = SMALLER(exists3, (around - at1 * at1) * e2_left_weight);
                const real d1 = azimuth_off + turned1, slack3 = hinge(3, c3, s3, n_);
                const real fx = fx0 + fxc * c3 + fxs * s3, fy = fy0 + fyc * c3 + fys * s3;
                const real fu = fxs * c3 - fxc * s3, fv = fys * c3 - fyc * s3;
                const real f = wp::sqrt(LARGER(fx * fx + fy * fy, TINY)), i_f = ONE / f;
                const real f_along = SIZE(fx * fu + fy * fv) * i_f * d3 + f_size * bend3;
                const real f_off = OVER(SIZE(fx * fv - fy * fu) * i_f * d3 + f_size * bend3, f - f_along);
                const real c3r = c3 * delta_c + s3 * delta_s, s3r = s3 * delta_c - c3 * delta_s;
                #pragma unroll
                for (int b_one = 0; b_one < 2; b_one++) {
                    const real side1 = b_one ? -half1 : half1;
                    const real X = r * (k1 * e2_left_x - side1 * e2_left_y);
                    const real Y = r * (k1 * e2_left_y + side1 * e2_left_x);
                    const real c1 = (px * X + py * Y) * ir * ir, s1 = (py * X - px * Y) * ir * ir;
                    const real gx = X - a1, gy = ca1 * Y + sa1 * pz, g = wp::sqrt(LARGER(gx * gx + gy * gy, TINY));
                    const real i_g = ONE / g, g_bent = HALF * r * turned1 * turned1 + r_off + SIZE(sa1) * pz_off;
                    const real g_along = SIZE(gy * ca1 * X - gx * Y) * i_g * turned1 + g_bent;
                    const real g_off = OVER(SIZE(gx * ca1 * X + gy * Y) * i_g * turned1 + g_bent, g - g_along);
                    const real i_fg = i_f * i_g, c2 = (fx * gx + fy * gy) * i_fg, s2 = (fx * gy - fy * gx) * i_fg;
                    const real slack1 = hinge(1, c1, s1, n_), slack2 = hinge(2, c2, s2, n_), d2 = f_off + g_off;
                    const real there = SMALLER(SMALLER(exists, slack1), SMALLER(slack2, slack3));
                    const real may = SMALLER(SMALLER(slack1 + d1, slack2 + d2), slack3 + d3);
                    const real S = SMALLER(d1 + d2 + d3 + TURN_OFF + near_turn, BIG);
                    real v0 = A02, v1 = A12, v2 = A22, m0 = A00, m1 = A10, m2 = A20;
                    ROTATED(v, c1, s1, 1) ROTATED(m, c1, s1, 1)
                    ROTATED(v, c2, s2, 2) ROTATED(m, c2, s2, 2)
                    ROTATED(v, c3r, s3r, 3) ROTATED(m, c3r, s3r, 3)
                    WRIST
                }
            }
            best[lane] = most;
            bound[lane] = within;
""".replace("WRIST", wrist_postures(_WRIST))

# How a target is seen from where the free joint stands at x.
_HINGE = {
    "PLACED": """
            // (cosine, sine) of x by those of its eighth, which the angle's double formula makes three times.
            const real eighth = x[lane] * real(0.125), z8 = eighth * eighth;
            real sx = eighth * (ONE + z8 * (real(-1.0 / 6) + z8 * (real(1.0 / 120) + z8 * (real(-1.0 / 5040)
                + z8 * (real(1.0 / 362880) + z8 * (real(-1.0 / 39916800) + z8 * real(1.0 / 6227020800.0)))))));
            real cx = ONE + z8 * (-HALF + z8 * (real(1.0 / 24) + z8 * (real(-1.0 / 720) + z8 * (real(1.0 / 40320)
                + z8 * (real(-1.0 / 3628800) + z8 * (real(1.0 / 479001600) + z8 * real(-1.0 / 87178291200.0)))))));
            #define DOUBLED { const real t_ = 2 * sx; cx = ONE - t_ * sx; sx = t_ * c_; }
            { const real c_ = cx; DOUBLED } { const real c_ = cx; DOUBLED } { const real c_ = cx; DOUBLED }
            TURNED(g0, g1, cx, sx) TURNED(h0, h1, cx, sx) TURNED(qx, qy, cx, sx)
            #define MOVED(i, j, k) (link##i * qy - link##j * qx)
            #define VALUE_OFF(k) (SIZE(turn##k##_x * qy - turn##k##_y * qx) * wide + turn##k##_size * far)
    """,
    "FAR": "HALF * radius[lane] * wide * wide",
    "TURN_OFF": "wide",
}
_SLIDE = {
    "PLACED": """
            qz -= x[lane];
            #define MOVED(i, j, k) (-link##k)
            #define SLOPE(k) (2 * sq##k * (px * tx + py * ty + pz * tz) + e##k##_lz * tz)
            #define VALUE_OFF(k) ((SIZE(SLOPE(k)) + sq##k * wide) * wide)
    """,
    "FAR": "ZERO",
    "TURN_OFF": "ZERO",
}
