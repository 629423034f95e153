"""The search of `wsrender_kernels.free_joint` level by level, for a GPU: labels alone.

A launch looks at all balls of a level, of whatever pose, and lists those of the next, so that threads side by side have
one ball each, where with a pose each they wait for the one that takes the most. What begins a pose is computed once and
kept. Roots come one by one, as most poses that are reached are by the first of them; halves of the open ones together.

In float32 balls only find postures; what has none clear of its limits goes on in float64, which alone closes balls. No
label depends on the order of a list, as a pose is what the highest of REACHED, UNDECIDED, UNREACHABLE that its balls
give it, and one that has more than so many balls of a level is UNDECIDED.
"""

import warp as wp

from wsrender_kernels.factories import factory
from wsrender_kernels.free_joint import (
    ARCS,
    REACHED,
    ROOTS,
    UNDECIDED,
    UNREACHABLE,
    FreeJointShape,
    ball_of,
    begin_of,
    lanes_of,
)
from wsrender_kernels.options import CUDA_OPTIONS, LONG_OPTIONS

TRIED = ROOTS  # levels in float32, one root each
LEVELS = TRIED + ROOTS + ARCS + 16  # and halves, of roots of at most pi / ROOTS to both sides down to 2e-5 rad
POSE_ROWS = 12 + 2 * ARCS  # numbers that are kept of a pose: c, off, size, radius, and its arcs
CLEAR = 1e-3  # slack of a posture that is one whatever float32 rounds


@factory
def free_joint_start_kernel(shape: FreeJointShape, cuda: bool) -> wp.Kernel:
    """Kernel that begins poses ``first`` and on, ``count`` of them, of those of `free_joint_kernel`, by ``tasks``.

    Out: ``state`` of all poses; ``kept`` (POSE_ROWS * count,), and the list of ``items`` of ``level`` with the first
    root of those that have one, ``counts[level]`` of them, 0 before.
    """
    real = shape.real
    reals, integers = wp.array(dtype=real), wp.array(dtype=wp.int32)

    @wp.func_native(_start(shape))
    def block(
        task: wp.int32,
        tasks: wp.int32,
        level: wp.int32,
        first: wp.int32,
        count: wp.int32,
        capacity: wp.int32,
        numbers: reals,
        poses: reals,
        tips: reals,
        state: integers,
        kept: reals,
        items: integers,
        counts: integers,
    ): ...

    @wp.kernel(module="unique", module_options=CUDA_OPTIONS if cuda else LONG_OPTIONS, enable_backward=False)
    def free_joint_start(
        # in
        tasks: wp.int32,
        level: wp.int32,
        first: wp.int32,
        count: wp.int32,
        capacity: wp.int32,
        numbers: wp.array(dtype=real),
        poses: wp.array(dtype=real),
        tips: wp.array(dtype=real),
        # out
        state: wp.array(dtype=wp.int32),
        kept: wp.array(dtype=real),
        items: wp.array(dtype=wp.int32),
        counts: wp.array(dtype=wp.int32),
    ):
        block(wp.tid(), tasks, level, first, count, capacity, numbers, poses, tips, state, kept, items, counts)

    return free_joint_start


@factory
def free_joint_level_kernel(shape: FreeJointShape, cuda: bool) -> wp.Kernel:
    """Kernel of a level; of float32 one of the first TRIED.

    In: as `free_joint_start_kernel` and `free_joint_kernel` have them, the ``widest`` level of a pose, in balls, and
    what is ``kept``. Of ``items`` (4 * capacity,), two lists of pairs of a pose and a ball, list ``level`` % 2 is read
    and the other written; ``counts`` (LEVELS + 1,): their lengths, or what they would be were there room. ``open``
    (count,) and ``width`` (3 * count,) are 0 at first. In and out: ``state``.
    """
    real = shape.real
    reals, doubles, integers = wp.array(dtype=real), wp.array(dtype=wp.float64), wp.array(dtype=wp.int32)

    @wp.func_native(_level(shape))
    def block(
        task: wp.int32,
        tasks: wp.int32,
        level: wp.int32,
        first: wp.int32,
        count: wp.int32,
        capacity: wp.int32,
        widest: wp.int32,
        narrow: real,
        numbers: reals,
        kept: doubles,
        state: integers,
        open: integers,
        width: integers,
        items: integers,
        counts: integers,
    ): ...

    @wp.kernel(module="unique", module_options=CUDA_OPTIONS if cuda else LONG_OPTIONS, enable_backward=False)
    def free_joint_level(
        # in
        tasks: wp.int32,
        level: wp.int32,
        first: wp.int32,
        count: wp.int32,
        capacity: wp.int32,
        widest: wp.int32,
        narrow: real,
        numbers: wp.array(dtype=real),
        kept: wp.array(dtype=wp.float64),
        # out
        state: wp.array(dtype=wp.int32),
        open: wp.array(dtype=wp.int32),
        width: wp.array(dtype=wp.int32),
        items: wp.array(dtype=wp.int32),
        counts: wp.array(dtype=wp.int32),
    ):
        block(
            wp.tid(),
            tasks,
            level,
            first,
            count,
            capacity,
            widest,
            narrow,
            numbers,
            kept,
            state,
            open,
            width,
            items,
            counts,
        )

    return free_joint_level


# A ball is its root's number, how often that was halved, and the path there, from bits 28, 23 and 0.
_LISTS = """
    constexpr int lanes = 1, lane = 0;
    auto added = [](int* at) -> int {
        #ifdef __CUDA_ARCH__
        return atomicAdd(at, 1);
        #else
        return (*at)++;
        #endif
    };
    auto raised = [](int* at, int to) {
        #ifdef __CUDA_ARCH__
        atomicMax(at, to);
        #else
        if (to > *at) *at = to;
        #endif
    };
    auto listed = [&](int to, int pose, unsigned ball) {
        const int at = added(counts.data + to);
        int* item = items.data + 2 * (capacity * (to % 2) + at);
        if (at < capacity) item[0] = pose, item[1] = (int)ball;
    };
"""


def _start(shape: FreeJointShape) -> str:
    return f"""
    {_LISTS}
    {lanes_of(shape)}
    auto finish = [&](int, int found) {{
        state.data[search[lane].pose] = found;
        search[lane].pose = -1;
    }};
    {begin_of(shape)}
    for (int one = task; one < count; one += tasks) {{
        begin(lane, first + one);
        const Search& s = search[lane];
        if (s.pose < 0) continue;
        state.data[s.pose] = {UNREACHABLE};  // unless balls say otherwise
        real* at = kept.data + one;
        for (int k = 0; k < 9; k++) at[k * count] = c[k][lane];
        at[9 * count] = off[lane], at[10 * count] = size[lane], at[11 * count] = radius[lane];
        for (int k = 0; k < {ARCS}; k++) at[(12 + k) * count] = s.start[k], at[({12 + ARCS} + k) * count] = s.half[k];
        listed(level, one, 0u);
    }}
    """


def _level(shape: FreeJointShape) -> str:
    single = shape.real is wp.float32
    return f"""
    {_LISTS}
    {lanes_of(shape)}
    const int many = counts.data[level] < capacity ? counts.data[level] : capacity;
    for (int entry = task; entry < many; entry += tasks) {{
        const int* item = items.data + 2 * (capacity * (level % 2) + entry);
        const int one = item[0];
        const unsigned ball = (unsigned)item[1];
        int* found = state.data + first + one;
        if (*found == {REACHED}) continue;
        const double* at = kept.data + one;
        for (int k = 0; k < 9; k++) c[k][lane] = (real)at[k * count];
        off[lane] = (real)at[9 * count], size[lane] = (real)at[10 * count], radius[lane] = (real)at[11 * count];
        Search& s = search[lane];
        s = Search();
        for (at += 12 * count; s.arcs < {ARCS} && at[{ARCS} * count] > 0; s.arcs++, at += count) {{
            s.start[s.arcs] = (real)at[0], s.half[s.arcs] = (real)at[{ARCS} * count];
        }}
        deal(s);
        const int number = ball >> 28;
        root(lane, number);
        s.depth = ball >> 23 & 31, s.path = ball & 0x7fffff;
        place(lane);
        {"" if single else _COUNTED}
        {{ {ball_of(shape)} }}
        {_TRIED if single else _DECIDED}
    }}
    """


_TRIED = f"""
        if (best[lane] > real({CLEAR})) raised(found, {REACHED});
        else listed(level + 1, one, level + 1 < {TRIED} ? (unsigned)(number + 1) << 28 : 0u);
"""

_COUNTED = f"""
        int *wide = width.data + 3 * one, *next_wide = wide + (level + 1) % 3;
        wide[(level + 2) % 3] = 0;
        if (wide[level % 3] > widest) {{ raised(found, {UNDECIDED}); continue; }}
"""

_DECIDED = f"""
        if (best[lane] > margin) {{ raised(found, {REACHED}); continue; }}
        const bool closed = bound[lane] < -margin;
        const bool small = !closed && (bound[lane] <= margin || w[lane] < narrow || level + 1 == {LEVELS});
        if (small) raised(found, {UNDECIDED});
        auto halves = [&](unsigned root, unsigned depth, unsigned path) {{
            for (unsigned side = 0; side < 2; side++) {{
                listed(level + 1, one, root << 28 | (depth + 1) << 23 | path << 1 | side);
                added(next_wide);
            }}
        }};
        const bool whole = !closed && !small;
        if (s.depth) {{ if (whole) halves(number, s.depth, s.path); continue; }}
        const unsigned left = (unsigned)open.data[one] | (whole ? 1u << number : 0u);
        open.data[one] = (int)left;
        if (number + 1 < s.roots) {{
            listed(level + 1, one, (unsigned)(number + 1) << 28);
            continue;
        }}
        for (int k = 0; k < s.roots; k++) if (left >> k & 1) halves(k, 0, 0);
"""
