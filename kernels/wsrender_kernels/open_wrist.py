"""Arms of six hinges whose axes 4 and 5 meet, but not axis 6 with them: a search along joint 6, in balls.

Where joint 6 stands at x, it is known where axes 4 and 5 meet, which joints 1 to 3 alone move: joint 3 by an equation
that holds it alone, then joint 1, then joint 2, four branches. In each one equation is left, f(x) = cosine between
axes 4 and 5, less what it is; joints 4 and 5 follow. A ball is all x within w of a centre. Anywhere in it joints 1 to
3 stand elsewhere than at the centre by no more than a bound, as in `wsrender_kernels.free_joint`; axes 4 and 5 turn
against each other by no more than S, what joints 1 to 3 and axis 5 do in sum, hence f by no more than sin(angle) S +
S² / 2. A branch in which f stays off 0, or a joint beyond its limits, or which exists nowhere, has no posture in the
ball: it is closed, else it is halved. Bounds hold for poses that differ from the target by no more than ``near`` as
well: none of them is reached where all balls are closed.

Labels: Newton's steps along x from centres close to a root; a posture within the limits reaches the pose. Sets: where
S is small f is looked at as a curve, by values and slopes at the ends and the centre. What it has of the fourth and
fifth degree these tell; it is off the cubics between them by that and as much again at most, which is assumed: terms
beyond are no larger. Where either half then has one extremum at most, a change of sign is a root, and of slope an
extremum, with two roots, one or none; else the ball is halved.
"""

from dataclasses import dataclass

import warp as wp

from wsrender_kernels.closed_form import (
    DOUBTFUL,
    FIELDS,
    POSTURE_ROWS,
    closed_form_prelude,
    target_in_frame,
)
from wsrender_kernels.factories import factory
from wsrender_kernels.free_joint import REACHED, UNDECIDED, UNREACHABLE, pose_rows
from wsrender_kernels.options import CUDA_OPTIONS, LONG_OPTIONS

BALL_LANES, POSES = 16, 256  # of a task of the CPU, which searches for twice as many at a time; on CUDA one
ROOTS, ARCS = 16, 6  # balls that a search begins with, and one more for every further arc
SET = 24  # postures of a pose that are kept, at most: 16 exist without limits
EDGE = 1e-4  # slack of postures that are kept though they seem outside the limits: rounding, near folds
CURVED, SAFETY = 0.3, 2  # S of balls whose f is looked at as a curve, and terms of all degrees over those known
FOLD = 0.65  # of a branch's sine at the centre of such a ball: less nowhere in it, since series end at folds
STEPS, MOST_STEPS = 7, 48  # of Newton, in labels and in sets

# Numbers of an arm beyond FIELDS. ``b5``, ``along5``: from the meeting point to the foot on axis 6, across and along.
OPEN_FIELDS = (
    *FIELDS,
    *("a5", "b5", "along5"),
    *("right1_low", "right1_high"),  # of what equation 1's right side is within joint 3's limits
    *("half", "middle_c", "middle_s"),  # of joint 6's range, and its middle, which 0 is [rad]
    *("right2_size", "f_size"),  # how far equation 2's right side and the centre before joint 2 are moved by joint 3
    *("origin0", "origin1", "origin2", "scale"),  # where the chain's world begins [m], and 1 / reach
    *("near", "near_by", "near_turn"),  # a pose's centre is off by near + near_by times its distance, and turned
)


@dataclass(frozen=True)
class OpenWristShape:
    """The compile-time part: whether each of the two equations holds squares, and the arm is solved from its tip.

    ``sets``: whether all postures are looked for, else one.
    """

    real: type
    squares: tuple[int, int]
    backwards: bool
    sets: bool


@factory
def open_wrist_kernel(shape: OpenWristShape, cuda: bool) -> wp.Kernel:
    """Kernel of a class.

    In: ``count`` poses, the ``most`` evaluations of a pose, below what width balls are not halved [rad], ``numbers`` of
    the arm (OPEN_FIELDS), ``poses`` (16 * count,), matrices by rows, in the world, and ``tips`` (16,), the pose of the
    target in them. Out, (count,) each: ``state``,
    of sets their flags; ``found``, how many postures are kept; ``evaluations``; and ``kept``, their numbers as in
    `ClosedFormShape`, POSTURE_ROWS of posture k of pose i at [(i * K + k) * POSTURE_ROWS], K = SET, of labels 1: the
    posture with the largest slack that was found.
    """
    real = shape.real
    reals, integers = wp.array(dtype=real), wp.array(dtype=wp.int32)

    @wp.func_native(body(shape))
    def block(
        task: wp.int32,
        count: wp.int32,
        most: wp.int32,
        narrow: real,
        numbers: reals,
        poses: reals,
        tips: reals,
        state: integers,
        found: integers,
        evaluations: integers,
        kept: reals,
    ): ...

    @wp.kernel(module="unique", module_options=CUDA_OPTIONS if cuda else LONG_OPTIONS, enable_backward=False)
    def open_wrist(
        # in
        count: wp.int32,
        most: wp.int32,
        narrow: real,
        numbers: wp.array(dtype=real),
        poses: wp.array(dtype=real),
        tips: wp.array(dtype=real),
        # out
        state: wp.array(dtype=wp.int32),
        found: wp.array(dtype=wp.int32),
        evaluations: wp.array(dtype=wp.int32),
        kept: wp.array(dtype=real),
    ):
        block(wp.tid(), count, most, narrow, numbers, poses, tips, state, found, evaluations, kept)

    return open_wrist


def body(shape: OpenWristShape) -> str:
    """C++ of one task."""
    own = OPEN_FIELDS[len(FIELDS) :]
    names = "\n".join(f"const real {name} = numbers.data[{len(FIELDS) + k}];" for k, name in enumerate(own))
    loop = """
            #ifndef __CUDA_ARCH__
            #pragma clang loop vectorize(assume_safety) interleave_count(1)
            #endif
            for (int lane = 0; lane < lanes; lane++) {"""
    return f"""
    {closed_form_prelude(shape.real)}
    {names}
    const real sq1 = {shape.squares[0]}, sq2 = {shape.squares[1]};
    const real HALF = real(0.5), BIG = 8, TURN = real(6.283185307179586);
    const int many = 1;
    const bool sets = {str(shape.sets).lower()};
    const real fold = real({FOLD});
    const real edge = sets ? real({EDGE}) : margin;
    #ifdef __CUDA_ARCH__
    constexpr int lanes = 1, chunk = 1, slots = 1;
    #else
    constexpr int lanes = {BALL_LANES}, chunk = {POSES}, slots = 2 * lanes;
    #endif
    const int last = SMALLER((task + 1) * chunk, count);
    int next = task * chunk;
    // Of a pose that is searched for: what turns with x, the ball, and a point of one of its branches.
    real c[12][slots], x[slots], w[slots], off[slots], size[slots], swing1[slots], swing2[slots];
    real at[slots], side1[slots], side3[slots];
    // What evaluations find: of a ball by branch, of a point.
    real bound[4][lanes], turned[4][lanes], there[4][lanes], value[4][lanes], rise[4][lanes];
    real point[{POSTURE_ROWS}][lanes], slope[lanes], height[lanes];
    {_SEARCH.replace("TARGET", target_in_frame(pose_rows(shape.backwards)))}
    for (int slot = 0; slot < slots; slot++) search[slot].pose = -1;
    for (;;) {{
        int balls = 0, points = 0, ball_of[slots + lanes], point_of[slots + lanes];
        for (int slot = 0; slot < slots; slot++) {{
            while (search[slot].pose < 0 && next < last) begin(slot, next++);
            if (search[slot].pose < 0) continue;
            if (search[slot].looks) point_of[points++] = slot; else ball_of[balls++] = slot;
        }}
        if (balls + points == 0) break;
        if (balls >= points) {{
            for (int lane = balls; lane < lanes; lane++) ball_of[lane] = ball_of[0];
            {loop}
                const int slot = ball_of[lane];
                const real x_ = x[slot];
                {_AT}
                {_BALL}
            }}
            for (int lane = 0; lane < SMALLER(balls, lanes); lane++) after_ball(ball_of[lane], lane);
        }} else {{
            for (int lane = points; lane < lanes; lane++) point_of[lane] = point_of[0];
            {loop}
                const int slot = point_of[lane];
                const real x_ = at[slot];
                {_AT}
                {_POINT}
            }}
            for (int lane = 0; lane < SMALLER(points, lanes); lane++) after_point(point_of[lane], lane);
        }}
    }}
    """


# What is known of a slot's pose, and the ball or point that comes next. Halves of a root are numbered by depth and
# path, whose bit k is the side taken k levels above; ``masks``: branches that are open in the halves of each depth.
_SEARCH = f"""
    struct Interval {{ real low, high, value_low, value_high, rise_low, rise_high; bool extremum; }};
    struct Search {{
        int pose, arcs, roots, number, depth, evaluations, found, branch, step, intervals;
        int pieces[{ARCS}];
        unsigned path, open, todo;
        unsigned char masks[32], rest[{ROOTS + ARCS}];
        real start[{ARCS}], half[{ARCS}], root_x, root_w, score, bent;
        real value[4], rise[4], turned[4], there[4];
        Interval interval[6];
        bool halving, doubt, looks;
    }};
    Search search[slots];
    constexpr int set = sets ? {SET} : 1;
    auto place = [&](int slot) {{
        Search& s = search[slot];
        const real width = s.root_w / (real)(1u << s.depth);
        x[slot] = s.root_x - s.root_w + width * (real)(2u * s.path + 1u);
        w[slot] = width * real(1.0000001);
    }};
    // Roots come in an order that does not begin with neighbours.
    auto root = [&](int slot, int number) {{
        Search& s = search[slot];
        int piece = (number * (s.roots % 5 ? 5 : 3) + s.roots / 2) % s.roots, arc = 0;
        while (arc + 1 < s.arcs && piece >= s.pieces[arc]) piece -= s.pieces[arc++];
        s.number = number, s.depth = 0, s.path = 0, s.masks[0] = 15;
        s.root_w = s.half[arc] / s.pieces[arc];
        s.root_x = s.start[arc] + s.root_w * (2 * piece + 1);
        place(slot);
    }};
    auto finish = [&](int slot, int result) {{
        Search& s = search[slot];
        state.data[s.pose] = sets ? (s.doubt ? {DOUBTFUL} : 0) : result;
        found.data[s.pose] = s.found, evaluations.data[s.pose] = s.evaluations;
        s.pose = -1;
    }};
    auto over = [&](int slot) {{ finish(slot, search[slot].doubt ? {UNDECIDED} : {UNREACHABLE}); }};
    auto halve = [&](int slot, unsigned open) {{
        Search& s = search[slot];
        s.depth++, s.path <<= 1, s.masks[s.depth] = open;
        place(slot);
    }};
    auto next_root = [&](int slot) {{
        Search& s = search[slot];
        int number = s.halving ? s.number + 1 : 0;
        s.halving = true;
        while (number < s.roots && !s.rest[number]) number++;
        if (number == s.roots) {{ over(slot); return; }}
        root(slot, number);
        halve(slot, s.rest[number]);
    }};
    // The next branch to look at, or the next ball.
    auto proceed = [&](int slot) {{
        Search& s = search[slot];
        s.looks = s.todo != 0;
        if (s.evaluations >= most) {{ s.doubt = true; over(slot); return; }}
        if (s.looks) {{
            s.branch = s.todo & 1 ? 0 : (s.todo & 2 ? 1 : (s.todo & 4 ? 2 : 3));
            s.todo &= ~(1u << s.branch), s.step = 0, s.intervals = 0;
            side3[slot] = s.branch & 2 ? -ONE : ONE, side1[slot] = s.branch & 1 ? -ONE : ONE;
            at[slot] = sets ? x[slot] - w[slot] : x[slot];
        }} else if (!s.halving) {{
            s.rest[s.number] = s.open;
            if (s.number + 1 < s.roots) root(slot, s.number + 1); else next_root(slot);
        }} else if (s.open) halve(slot, s.open);
        else {{
            while (s.depth && (s.path & 1)) s.path >>= 1, s.depth--;
            if (s.depth) {{ s.path |= 1; place(slot); }} else next_root(slot);
        }}
    }};
    auto after_ball = [&](int slot, int lane) {{
        Search& s = search[slot];
        s.evaluations++, s.open = 0, s.todo = 0;
        const bool small = w[slot] < narrow || s.depth > 28;
        for (int b = 0; b < 4; b++) {{
            if (!(s.masks[s.depth] >> b & 1) || bound[b][lane] < -edge) continue;
            s.value[b] = value[b][lane], s.rise[b] = rise[b][lane], s.there[b] = there[b][lane];
            s.turned[b] = turned[b][lane];
            if (sets) {{
                if (small || s.turned[b] <= real({CURVED})) s.todo |= 1u << b; else s.open |= 1u << b;
                continue;
            }}
            const bool doubt = small || bound[b][lane] <= margin;
            const real step = SIZE(s.value[b]), reach = w[slot] * SIZE(s.rise[b]);
            if (doubt || step <= real(1.5) * reach) s.todo |= 1u << b;
            if (!doubt) s.open |= 1u << b;
            s.doubt |= doubt;
        }}
        proceed(slot);
    }};
    auto keep = [&](int slot, int lane, int place) {{
        real* to = kept.data + ((long long)search[slot].pose * set + place) * {POSTURE_ROWS};
        for (int r = 0; r < {POSTURE_ROWS}; r++) to[r] = point[r][lane];
        search[slot].found = LARGER(search[slot].found, place + 1);
    }};
    auto emit = [&](int slot, int lane) {{
        Search& s = search[slot];
        if (point[12][lane] < -edge) return;
        // Near a posture at most: between two folds, where the branch is not, and at an extremum that is close to 0.
        if (!(point[13][lane] > ZERO && SIZE(height[lane]) < real(1e-10)))
            s.doubt = true, point[12][lane] = SMALLER(point[12][lane], ZERO);
        if (s.found < set) keep(slot, lane, s.found); else s.doubt = true;
    }};
    auto piece = [&](Search& s, real low, real high, real value_low, real value_high, real rise_low, real rise_high) {{
        const bool crossed = (value_low > ZERO) != (value_high > ZERO);
        if (!crossed) {{
            const bool within = value_low * rise_low < ZERO && value_high * rise_high > ZERO;
            // Beside a point where f touches 0, or joints fold too, its signs and slopes are rounding.
            s.doubt |= SMALLER(SIZE(value_low), SIZE(value_high)) < real(1e-10);
            if (!within) return;
        }}
        if (s.intervals < 6)
            s.interval[s.intervals++] = {{low, high, value_low, value_high, rise_low, rise_high, !crossed}};
    }};
    // Between an end and the centre f is near its cubic there, whose slope is off by ``bent`` times the weight that
    // Bernstein's form of it gives its middle number: what f has of the fourth and fifth degree, and as much again.
    // By how much f is off 0 at least, between points that are ``length`` apart; negative where that is not known.
    auto off_zero = [&](Search& s, real width, real length, real low, real high, real rise_low, real rise_high) {{
        const real sign = low > ZERO ? ONE : -ONE, third = length / 3, share = length / width;
        const real inner = SMALLER(sign * (low + third * rise_low), sign * (high - third * rise_high));
        return SMALLER(inner - s.bent * share * share * share * length / 12, SMALLER(sign * low, sign * high));
    }};
    // Where a root, or an extremum, of the last interval is looked for first: those of a line, and of the cubic.
    auto look = [&](int slot) {{
        Search& s = search[slot];
        const Interval& i = s.interval[s.intervals - 1];
        real share = i.value_low / (i.value_low - i.value_high);
        if (i.extremum) {{
            const real d = i.rise_low + i.rise_high - 3 * (i.value_high - i.value_low) / (i.high - i.low);
            const real root = ROOT(d * d - i.rise_low * i.rise_high), turn = i.rise_high > ZERO ? root : -root;
            share = ONE - (i.rise_high + turn - d) / (i.rise_high - i.rise_low + 2 * turn);
        }}
        share = SMALLER(LARGER(share, real(0.02)), real(0.98));
        at[slot] = i.low + (share == share ? share : HALF) * (i.high - i.low);
        s.step = 2;
    }};
    auto after_point = [&](int slot, int lane) {{
        Search& s = search[slot];
        const real f = height[lane], g = slope[lane], x_ = at[slot], width = w[slot];
        s.evaluations++;
        const real by = SIZE(g) > TINY ? -f / g : ZERO;
        if (!sets) {{
            const bool settled = SIZE(f) < real(1e-12) || s.step >= {STEPS};
            if (!settled) {{ s.step++, at[slot] += SMALLER(LARGER(by, -width), width); return; }}
            if (!(SIZE(f) < real(1e-10))) point[12][lane] = SMALLER(point[12][lane], ZERO) - SIZE(f);
            if (point[12][lane] > s.score) s.score = point[12][lane], keep(slot, lane, 0);
            if (s.score > margin) finish(slot, {REACHED}); else proceed(slot);
            return;
        }}
        const int b = s.branch;
        if (s.step < 2) {{
            // Both ends, then what lies between them and the centre.
            Interval& whole = s.interval[5];
            const bool exists = point[13][lane] > ZERO;
            if (s.step == 0) {{
                whole.value_low = f, whole.rise_low = g, s.step = 1, at[slot] = x[slot] + width;
                s.there[b] = exists ? s.there[b] : -ONE;
                return;
            }}
            const real f0 = s.value[b], g0 = s.rise[b], fa = whole.value_low, ga = whole.rise_low;
            const real cubic = HALF * (fa + f) + width * (ga - g) / 4;
            const real tilt = (3 * (f - fa) / width - ga - g) / 4;
            s.bent = {SAFETY} * (SIZE(f0 - cubic) / width + real(3.125) * SIZE(g0 - tilt));
            const bool small = width < narrow || s.depth > 28;
            // Whether f is off 0, or has no extremum, or one: no more than its numbers change their sign.
            auto plain = [&](real low, real high, real rise_low, real rise_high) {{
                if (off_zero(s, width, width, low, high, rise_low, rise_high) > ZERO) return true;
                if (rise_low * rise_high < ZERO) return SIZE(rise_low - rise_high) > 4 * s.bent;
                const real middle = 3 * (high - low) / width - rise_low - rise_high;
                return (rise_low > ZERO ? middle : -middle) - s.bent > -ROOT(rise_low * rise_high);
            }};
            const bool shown = plain(fa, f0, ga, g0) && plain(f0, f, g0, g);
            if (!(exists && s.there[b] > ZERO && shown)) {{
                if (!small) {{ s.open |= 1u << b; proceed(slot); return; }}
                s.doubt = true;
            }}
            const real x0 = x[slot];
            piece(s, x0 - width, x0, fa, f0, ga, g0);
            piece(s, x0, x0 + width, f0, f, g0, g);
            if (s.intervals) look(slot); else proceed(slot);
            return;
        }}
        Interval i = s.interval[s.intervals - 1];
        const bool worn = ++s.step > {MOST_STEPS};
        if (i.extremum) {{
            if ((f > ZERO) != (i.value_low > ZERO)) {{
                s.interval[s.intervals - 1] = {{i.low, x_, i.value_low, f, i.rise_low, g, false}};
                if (s.intervals < 5) s.interval[s.intervals++] = {{x_, i.high, f, i.value_high, g, i.rise_high, false}};
                look(slot);
                return;
            }}
            if (g * i.rise_low > ZERO) i.low = x_, i.value_low = f, i.rise_low = g;
            else i.high = x_, i.value_high = f, i.rise_high = g;
            const real off_0 = off_zero(s, width, i.high - i.low, i.value_low, i.value_high, i.rise_low, i.rise_high);
            if (off_0 > real(1e-9)) s.intervals--;
            else if (worn || (off_0 > ZERO && SIZE(f) < real(1e-9))) {{
                s.doubt = true, emit(slot, lane), s.intervals--;
            }} else {{
                s.interval[s.intervals - 1] = i;
                const int step = s.step;
                look(slot);
                s.step = step;
                return;
            }}
        // Where joints 1 to 3 nearly fold, they are off by far more than x is: f says so.
        }} else if (SIZE(f) < real(1e-14) || (SIZE(by) < real(1e-10) && SIZE(f) < real(1e-10)) || worn) {{
            s.doubt |= worn;
            emit(slot, lane);
            s.intervals--;
        }} else {{
            if ((f > ZERO) == (i.value_low > ZERO)) i.low = x_, i.value_low = f;
            else i.high = x_, i.value_high = f;
            s.interval[s.intervals - 1] = i;
            const real newton = x_ + by;
            at[slot] = newton > i.low && newton < i.high && by != ZERO ? newton : HALF * (i.low + i.high);
            return;
        }}
        if (s.intervals) look(slot); else proceed(slot);
    }};
    auto arc = [&](Search& s, real low, real high) {{
        low = LARGER(low, -half), high = SMALLER(high, half);
        if (!(high <= low) && s.arcs < {ARCS}) s.start[s.arcs] = low, s.half[s.arcs++] = HALF * (high - low);
    }};
    auto begin = [&](int slot, int pose) {{
        Search& s = search[slot];
        s = Search();
        s.pose = pose, s.score = -4;
        {{
            TARGET
            c[0][slot] = A00, c[1][slot] = A10, c[2][slot] = A20, c[6][slot] = A02, c[7][slot] = A12, c[8][slot] = A22;
            c[3][slot] = A12 * A20 - A22 * A10, c[4][slot] = A22 * A00 - A02 * A20, c[5][slot] = A02 * A10 - A12 * A00;
            c[9][slot] = px - along5 * A02, c[10][slot] = py - along5 * A12, c[11][slot] = pz - along5 * A22;
        }}
        const real px = c[9][slot], py = c[10][slot], pz = c[11][slot];
        const real ux = -a5 * c[0][slot] - b5 * c[3][slot], vx = a5 * c[3][slot] - b5 * c[0][slot];
        const real uy = -a5 * c[1][slot] - b5 * c[4][slot], vy = a5 * c[4][slot] - b5 * c[1][slot];
        const real uz = -a5 * c[2][slot] - b5 * c[5][slot], vz = a5 * c[5][slot] - b5 * c[2][slot];
        const real squared = px * px + py * py + pz * pz, around = a5 * a5 + b5 * b5;
        size[slot] = wp::sqrt(squared) + wp::sqrt(around);
        if (!(size[slot] < real(1e6))) {{ s.doubt = true; over(slot); return; }}
        const real base = wp::sqrt(base9 * base9 + base10 * base10 + base11 * base11);
        off[slot] = near + near_by * (size[slot] + base);
        // The values of both equations are middle + swing cos(x - phase): where 1's is among what joint 3 may make.
        const real pu = 2 * (px * ux + py * uy + pz * uz), pv = 2 * (px * vx + py * vy + pz * vz);
        const real along = sq1 * pu + e1_lz * uz, aside = sq1 * pv + e1_lz * vz;
        const real along2 = sq2 * pu + e2_lz * uz, aside2 = sq2 * pv + e2_lz * vz;
        swing1[slot] = wp::sqrt(along * along + aside * aside);
        swing2[slot] = wp::sqrt(along2 * along2 + aside2 * aside2);
        const real swing = swing1[slot], middle = sq1 * (squared + around) + e1_lz * pz + e1_l0;
        const real slack = off[slot] * (sq1 * (2 * size[slot] + off[slot]) + SIZE(e1_lz)) + real(1e-9);
        const real low = (right1_low - slack - middle) / swing, high = (right1_high + slack - middle) / swing;
        if (!(swing > real(1e-9))) {{
            if (!(middle + swing < right1_low - slack || middle - swing > right1_high + slack)) arc(s, -half, half);
        }} else if (!(low > ONE || high < -ONE)) {{
            const real phase = wp::atan2(aside, along);
            const real inner = high < ONE ? wp::acos(high) : ZERO, outer = low > -ONE ? wp::acos(low) : HALF * TURN;
            if (inner == ZERO && outer == HALF * TURN) arc(s, -half, half);
            else for (int k = -1; k < 2; k++) {{
                const real at_ = phase + k * TURN;
                if (inner > ZERO) {{ arc(s, at_ - outer, at_ - inner); arc(s, at_ + inner, at_ + outer); }}
                else arc(s, at_ - outer, at_ + outer);
            }}
        }}
        real whole = ZERO;
        for (int k = 0; k < s.arcs; k++) whole += s.half[k];
        for (int k = 0; k < s.arcs; k++) {{
            s.pieces[k] = LARGER((int)({ROOTS} * s.half[k] / whole + real(0.999)), 1);
            s.roots += s.pieces[k];
        }}
        if (s.arcs) root(slot, 0); else over(slot);
    }};
"""

# Where axes 4 and 5 meet and axis 5 points where joint 6 stands at x_, by x too, and what equation 1 says of joint 3.
_AT = """
            // (cosine, sine) of x by those of its eighth, which the angle's double formula makes three times.
            const real eighth = x_ * real(0.125), z8 = eighth * eighth;
            real sx = eighth * (ONE + z8 * (real(-1.0 / 6) + z8 * (real(1.0 / 120) + z8 * (real(-1.0 / 5040)
                + z8 * (real(1.0 / 362880) + z8 * (real(-1.0 / 39916800) + z8 * real(1.0 / 6227020800.0)))))));
            real cx = ONE + z8 * (-HALF + z8 * (real(1.0 / 24) + z8 * (real(-1.0 / 720) + z8 * (real(1.0 / 40320)
                + z8 * (real(-1.0 / 3628800) + z8 * (real(1.0 / 479001600) + z8 * real(-1.0 / 87178291200.0)))))));
            #define DOUBLED { const real t_ = 2 * sx; cx = ONE - t_ * sx; sx = t_ * c_; }
            { const real c_ = cx; DOUBLED } { const real c_ = cx; DOUBLED } { const real c_ = cx; DOUBLED }
            const real X0 = cx * c[0][slot] - sx * c[3][slot], Y0 = sx * c[0][slot] + cx * c[3][slot];
            const real X1 = cx * c[1][slot] - sx * c[4][slot], Y1 = sx * c[1][slot] + cx * c[4][slot];
            const real X2 = cx * c[2][slot] - sx * c[5][slot], Y2 = sx * c[2][slot] + cx * c[5][slot];
            const real h0 = sa5 * Y0 + ca5 * c[6][slot], h1 = sa5 * Y1 + ca5 * c[7][slot];
            const real h2 = sa5 * Y2 + ca5 * c[8][slot];
            const real px = c[9][slot] - a5 * X0 - b5 * Y0, tx = a5 * Y0 - b5 * X0;
            const real py = c[10][slot] - a5 * X1 - b5 * Y1, ty = a5 * Y1 - b5 * X1;
            const real pz = c[11][slot] - a5 * X2 - b5 * Y2, tz = a5 * Y2 - b5 * X2;
            const real around = px * px + py * py, r = wp::sqrt(LARGER(around, TINY)), ir = ONE / r;
            const real squared = around + pz * pz, moved = 2 * (px * tx + py * ty + pz * tz);
            const real value1 = sq1 * squared + e1_lz * pz + e1_l0, slope1 = sq1 * moved + e1_lz * tz;
            const real value2 = sq2 * squared + e2_lz * pz + e2_l0, slope2 = sq2 * moved + e2_lz * tz;
            #define COSINE(a) SMALLER(LARGER(a, -ONE), ONE)
            #define APART(a) (SIZE(a) > TINY ? (a) : TINY)
            const real at3 = value1 * e1_right_scale, k3 = COSINE(at3), half3 = ROOT(ONE - k3 * k3);
            const real exists3 = (ONE - at3 * at3) * e1_right_weight;
            int n_ = 0;
"""

# Joint 3 on the side side3_, and what equation 2 then says of joint 1.
_THIRD = """
                const real c3 = k3 * e1_right_x - side3_ * half3 * e1_right_y;
                const real s3 = k3 * e1_right_y + side3_ * half3 * e1_right_x;
                const real rate3 = slope1 / APART(e1_rs * c3 - e1_rc * s3), bend2 = e2_rs * c3 - e2_rc * s3;
                const real at1 = (e2_rc * c3 + e2_rs * s3 - value2) * e2_left_scale;
                const real k1 = COSINE(at1 * ir), half1 = ROOT(ONE - k1 * k1);
                const real fx = fx0 + fxc * c3 + fxs * s3, fy = fy0 + fyc * c3 + fys * s3;
                const real fu = fxs * c3 - fxc * s3, fv = fys * c3 - fyc * s3;
                const real f = wp::sqrt(LARGER(fx * fx + fy * fy, TINY)), i_f = ONE / f;
                const real c3r = c3 * delta_c + s3 * delta_s, s3r = s3 * delta_c - c3 * delta_s;
                const real exists = SMALLER(exists3, (around - at1 * at1) * e2_left_weight);
"""

# Joint 1 on the side side1_, then joint 2; axis 5 (v) and x of joint 5 (m), seen from link 3; by x links move v by e.
_FIRST = """
                    const real X = r * (k1 * e2_left_x - side1_ * half1 * e2_left_y);
                    const real Y = r * (k1 * e2_left_y + side1_ * half1 * e2_left_x);
                    const real c1 = (px * X + py * Y) * ir * ir, s1 = (py * X - px * Y) * ir * ir;
                    const real gx = X - a1, gy = ca1 * Y + sa1 * pz, g = wp::sqrt(LARGER(gx * gx + gy * gy, TINY));
                    const real i_g = ONE / g, i_fg = i_f * i_g;
                    const real c2 = (fx * gx + fy * gy) * i_fg, s2 = (fx * gy - fy * gx) * i_fg;
                    const real ax = c1 * tx + s1 * ty, ay = c1 * ty - s1 * tx;
                    const real rate1 = (bend2 * rate3 - slope2 - e2_lx * ax - e2_ly * ay)
                        / APART(e2_lx * Y - e2_ly * X);
                    const real g_y = ca1 * (ay - rate1 * X) + sa1 * tz;
                    const real rate2 = (gx * g_y - gy * (ax + rate1 * Y)) * i_g * i_g
                        - (fx * fv - fy * fu) * rate3 * i_f * i_f;
                    real v0 = h0, v1 = h1, v2 = h2, m0 = X0, m1 = X1, m2 = X2, e0, e1, e2;
                    ROTATED(m, c1, s1, 1) ROTATED(m, c2, s2, 2) ROTATED(m, c3r, s3r, 3)
                    TURNED(v0, v1, c1, s1) e0 = rate1 * v1; e1 = -rate1 * v0; e2 = ZERO;
                    TILTED(v1, v2, ca1, sa1) TILTED(e1, e2, ca1, sa1)
                    TURNED(v0, v1, c2, s2) TURNED(e0, e1, c2, s2) e0 += rate2 * v1; e1 -= rate2 * v0;
                    TILTED(v1, v2, ca2, sa2) TILTED(e1, e2, ca2, sa2)
                    TURNED(v0, v1, c3r, s3r) TURNED(e0, e1, c3r, s3r) e0 += rate3 * v1; e1 -= rate3 * v0;
                    TILTED(v1, v2, ca3, sa3) TILTED(e1, e2, ca3, sa3)
                    const real rest = v2 - ca4, grows = sa5 * m2 + e2;
                    const real across = v0 * v0 + v1 * v1, i_a = ONE / wp::sqrt(LARGER(across, TINY));
                    const real c4 = -v1 * i_a, s4 = v0 * i_a, sign4 = sa4 < ZERO ? -ONE : ONE;
                    const real c5 = (v0 * m1 - v1 * m0) * i_a * sign4, s5 = m2 * i_a * sign4;
"""

_BALL = (
    """
            const real wide = w[slot], radius = wp::sqrt(a5 * a5 + b5 * b5);
            // By how much the point may be off, and what its second derivative and a pose nearby may add.
            const real nearby = off[slot], far = HALF * radius * wide * wide, bent = far + nearby;
            const real outward = SIZE(px * tx + py * ty) * ir * wide + bent;
            const real aside = SIZE(px * ty - py * tx) * ir * wide + bent;
            const real r_off = outward + HALF * aside * aside * ir, pz_off = SIZE(tz) * wide + bent;
            #define OVER(a, b) ((b) > ZERO ? SMALLER((a) / (b), BIG) : BIG)
            const real azimuth_off = OVER(aside, r - outward);
            // Between the angles of two points of a circle, or more.
            #define BETWEEN(c_, s_) ((c_) > ZERO ? 2 * SIZE(s_) / (ONE + (c_)) : BIG)
            const real near1 = nearby * (sq1 * (2 * size[slot] + nearby) + SIZE(e1_lz));
            const real near2 = nearby * (sq2 * (2 * size[slot] + nearby) + SIZE(e2_lz));
            const real value1_off = SIZE(slope1) * wide + HALF * swing1[slot] * wide * wide + near1;
            const real value2_off = SIZE(slope2) * wide + HALF * swing2[slot] * wide * wide + near2;
            const real off3 = value1_off * e1_right_scale;
            const real low3 = COSINE(at3 - off3), high3 = COSINE(at3 + off3);
            const real half_low3 = ROOT(ONE - low3 * low3), half_high3 = ROOT(ONE - high3 * high3);
            const real to_low3 = BETWEEN(k3 * low3 + half3 * half_low3, half3 * low3 - half_low3 * k3);
            const real to_high3 = BETWEEN(k3 * high3 + half3 * half_high3, half3 * high3 - half_high3 * k3);
            const real d3 = LARGER(to_low3, to_high3), bend3 = HALF * d3 * d3;
            const bool apart3 = SMALLER(half_low3, half_high3) > fold * half3;
            const real somewhere3 = ONE + off3 - SIZE(at3);
            #pragma unroll
            for (int b_three = 0; b_three < 2; b_three++) {
                const real side3_ = b_three ? -ONE : ONE;
"""
    + _THIRD
    + """
                const real right2_off = SIZE(bend2) * d3 + right2_size * bend3;
                const real off1 = (SMALLER(right2_off, 2 * right2_size) + value2_off) * e2_left_scale;
                const real up = at1 + off1, down = at1 - off1, near_r = r - r_off, far_r = r + r_off;
                const bool around1 = near_r > ZERO;
                const real i_near = ONE / (around1 ? near_r : r), i_far = ONE / far_r;
                real most1 = up * (up > ZERO ? i_near : i_far), least1 = down * (down < ZERO ? i_near : i_far);
                const real somewhere1 = around1 ? ONE - LARGER(least1, -most1) : ONE;
                // By its derivative, where the branch is, and twice what is beyond that; proofs do not take it.
                if (sets && exists > ZERO) {
                    const real rate = ((bend2 * rate3 - slope2) * e2_left_scale - at1 * HALF * (moved - 2 * pz * tz)
                        * ir * ir) * ir;
                    const real bent3 = SIZE(bend2) * LARGER(d3 - SIZE(rate3) * wide, ZERO) + right2_size * bend3;
                    const real bent2 = HALF * swing2[slot] * wide * wide + near2, r_share = r_off * ir;
                    const real D = HALF * (most1 - least1), turns = (bent3 + bent2) * e2_left_scale * ir;
                    const real by = SIZE(rate) * wide + 2 * (turns + r_share * (D + r_share) + far * ir);
                    most1 = SMALLER(most1, at1 * ir + by); least1 = LARGER(least1, at1 * ir - by);
                }
                const real low1 = COSINE(least1), high1 = COSINE(most1);
                const real half_low1 = ROOT(ONE - low1 * low1), half_high1 = ROOT(ONE - high1 * high1);
                const real to_low1 = BETWEEN(k1 * low1 + half1 * half_low1, half1 * low1 - half_low1 * k1);
                const real to_high1 = BETWEEN(k1 * high1 + half1 * half_high1, half1 * high1 - half_high1 * k1);
                const bool apart1 = SMALLER(half_low1, half_high1) > fold * half1;
                const real turned1 = around1 ? LARGER(to_low1, to_high1) : BIG;
                const real somewhere = SMALLER(somewhere3, somewhere1);
                const real d1 = azimuth_off + turned1, slack3 = hinge(3, c3, s3, n_);
                const real f_along = SIZE(fx * fu + fy * fv) * i_f * d3 + f_size * bend3;
                const real f_off = OVER(SIZE(fx * fv - fy * fu) * i_f * d3 + f_size * bend3, f - f_along);
                #pragma unroll
                for (int b_one = 0; b_one < 2; b_one++) {
                    const real side1_ = b_one ? -ONE : ONE;
"""
    + _FIRST
    + """
                    const real g_bent = HALF * r * turned1 * turned1 + r_off + SIZE(sa1) * pz_off;
                    const real g_along = SIZE(gy * ca1 * X - gx * Y) * i_g * turned1 + g_bent;
                    const real g_off = OVER(SIZE(gx * ca1 * X + gy * Y) * i_g * turned1 + g_bent, g - g_along);
                    const real d2 = f_off + g_off, d123 = SMALLER(d1 + d2 + d3 + near_turn, BIG);
                    const real S = d123 + SIZE(sa5) * wide, S5 = d123 + wide;
                    const real slack1 = hinge(1, c1, s1, n_), slack2 = hinge(2, c2, s2, n_);
                    const real may = SMALLER(SMALLER(slack1 + d1, slack2 + d2), slack3 + d3);
                    // Joints turn by asin(z) at most, and slack is a sine: it loses no more than z.
                    const real z4 = S * i_a, d4 = z4 < ONE ? z4 : BIG, z5 = S5 * i_a, d5 = z5 < ONE ? z5 : BIG;
                    const real wrist = SMALLER(hinge(4, c4, s4, n_) + d4, hinge(5, c5, s5, n_) + d5);
                    const real nonzero = SIZE(rest) - S * (wp::sqrt(across) + HALF * S);
                    const bool none = somewhere < real(-1e-9) || nonzero > real(1e-9);
                    const int b = 2 * b_three + b_one;
                    bound[b][lane] = none ? -ONE : SMALLER(may, wrist);
                    turned[b][lane] = S;
                    there[b][lane] = apart3 && apart1 ? exists + real(1e-12) : -ONE;
                    value[b][lane] = rest;
                    rise[b][lane] = grows;
                }
            }
"""
)

_POINT = (
    """
            const real side3_ = side3[slot], side1_ = side1[slot];
"""
    + _THIRD
    + _FIRST
    + """
            const real slack1 = hinge(1, c1, s1, n_), slack2 = hinge(2, c2, s2, n_), slack3 = hinge(3, c3, s3, n_);
            const real slack4 = hinge(4, c4, s4, n_), slack5 = hinge(5, c5, s5, n_);
            const real slack6 = half < HALF * TURN - real(1e-9) ? half - SIZE(x_) : ONE;
            const real limits = SMALLER(SMALLER(SMALLER(slack1, slack2), SMALLER(slack3, slack4)),
                SMALLER(slack5, slack6));
            point[0][lane] = c1, point[1][lane] = s1, point[2][lane] = c2, point[3][lane] = s2;
            point[4][lane] = c3, point[5][lane] = s3, point[6][lane] = c4, point[7][lane] = s4;
            point[8][lane] = c5, point[9][lane] = s5;
            point[10][lane] = cx * middle_c - sx * middle_s, point[11][lane] = sx * middle_c + cx * middle_s;
            point[12][lane] = sets ? limits : SMALLER(limits, exists);
            point[13][lane] = exists + real(1e-12);
            height[lane] = rest;
            slope[lane] = grows;
"""
)
