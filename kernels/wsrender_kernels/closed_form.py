"""All postures of poses in closed form, for arms whose class `wsrender.robots.closed_form` tells.

The text of the kernel's body is made for a class; numbers of the arm come from an array, so that one kernel serves all
arms of a class. On the CPU a task takes LANES poses side by side, on CUDA a thread takes one; both run the same text.

No angle is computed: joints are (cosine, sine), limits are arcs. Of a hinge that may turn by h to both sides of a
middle, the slack at t from the middle is sin(h - |t|), above 0 within the limits, about radians beside them; that of a
slide is in reaches. Discriminants, below 0 where a branch does not exist, are slacks too. A slack counts less where
small motions of the pose move joints far: it is multiplied by a lever for each root and length that angles before it
are divided by, as a joint that depends on another moves by the product of both. Hence the slack of a pose, the largest
of all its branches, says how far the pose is from where its label changes, and is about 0 near singular poses, where
joints may stand anywhere: they are undecided.

First three joints: Pieper 1968, by the two equations of `wsrender.robots.closed_form.classes`; the quartic of general
ones is a pencil of conics (Richter-Gebert 2011, 11.3). Three parallel axes: Hawkins 2013.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import warp as wp

from wsrender_kernels.factories import factory
from wsrender_kernels.options import CUDA_OPTIONS, LONG_OPTIONS, SHORT_OPTIONS

LANES = 16
BRANCHES = 8
# Cosines and sines of six hinges (of slides the displacement and 0), the slack without levers, and how sure that is: of
# a posture that counts its lever, of others the slack with levers.
POSTURE_ROWS = 14
TARGET_ROWS = 12  # rotation, row by row, and position
# Slack within which a posture is taken for one within limits that exists: rounding, near folds.
MARGIN = {wp.float32: 2e-5, wp.float64: 1e-7}
# Squared sine between axes 4 and 6 at which only the sum or difference of their angles counts.
SINGULAR = {wp.float32: 1e-8, wp.float64: 1e-20}
# A lever counts less than 1 where joints move five times as far as the pose.
STEEP = 5
FAMILY, DOUBTFUL = 1, 2  # flags
ARC = ("middle_c", "middle_s", "sine", "cosine", "narrow", "least", "turns", "lower", "upper")

# Numbers of an arm, in order. ``base`` and ``tool``: rows of rotations, then positions; p, a, offset in reaches.
FIELDS = (
    *(f"base{k}" for k in range(12)),
    *(f"tool{k}" for k in range(12)),
    *(f"{name}{k}" for k in (1, 2, 3) for name in ("a", "ca", "sa", "turn_c", "turn_s")),
    *(f"{name}{k}" for k in (4, 5) for name in ("ca", "sa")),
    *("delta_c", "delta_s"),  # from joint 3's angle in the equations to that of the links
    *(f"f{r}{k}" for r in "xyz" for k in "0cs"),  # the centre before joint 2, by 1, cos q3, sin q3; or 1, q3
    # Equations 1 and 2: left (3), constant, right (2); either's direction, 1 / length, and what its roots count.
    *(f"e{k}_{name}" for k in (1, 2) for name in ("lx", "ly", "lz", "l0", "rc", "rs")),
    *(
        f"e{k}_{name}"
        for k in (1, 2)
        for name in ("left_x", "left_y", "left_scale", "right_x", "right_y", "right_scale")
    ),
    *(f"e{k}_{name}" for k in (1, 2) for name in ("left_weight", "right_weight")),
    *("plane", "a4", "b4", "weight3"),  # of three parallel axes
    *(f"{name}{k}" for k in range(1, 9) for name in ARC),  # 7: sum of joints 4 and 6, 8: their difference
)


WORLD_FIELDS = (*FIELDS, "origin0", "origin1", "origin2", "scale")  # where the chain's world begins [m], and 1 / reach
REACHABLE, UNREACHABLE, UNDECIDED = 1, 0, -1  # labels


@dataclass(frozen=True)
class ClosedFormShape:
    """The compile-time part of a class.

    ``arm``: "nested", "general" or "parallel"; ``revolute``: of the first three joints; ``first``: the joint, 1 or 3,
    that the first equation holds alone; ``squares``: whether each of the two equations holds squares. ``keep``: whether
    postures are stored.
    """

    real: type
    arm: str
    revolute: tuple[bool, bool, bool]
    first: int = 1
    squares: tuple[int, int] = (0, 0)
    keep: bool = False


@factory
def closed_form_kernel(shape: ClosedFormShape, cuda: bool) -> wp.Kernel:
    """Kernel of a class.

    In: ``numbers`` of the arm (FIELDS), ``targets`` (TARGET_ROWS * count,), row r of pose i at [r * count + i], count a
    multiple of LANES. Out, (count,) each: how many ``postures`` are within the limits, windings apart, ``slack``
    and ``flags``; of a shape that keeps them ``kept`` (BRANCHES * POSTURE_ROWS * count,), row r of branch b at
    [(b * POSTURE_ROWS + r) * count + i].
    """
    real = shape.real
    reals, integers = wp.array(dtype=real), wp.array(dtype=wp.int32)

    @wp.func_native(body(shape))
    def block(
        task: wp.int32,
        count: wp.int32,
        numbers: reals,
        targets: reals,
        postures: integers,
        slack: reals,
        flags: integers,
        kept: reals,
    ): ...

    options = CUDA_OPTIONS if cuda else LONG_OPTIONS

    @wp.kernel(module="unique", module_options=options, enable_backward=False)
    def closed_form(
        # in
        count: wp.int32,
        numbers: wp.array(dtype=real),
        targets: wp.array(dtype=real),
        # out
        postures: wp.array(dtype=wp.int32),
        slack: wp.array(dtype=real),
        flags: wp.array(dtype=wp.int32),
        kept: wp.array(dtype=real),
    ):
        block(wp.tid(), count, numbers, targets, postures, slack, flags, kept)

    return closed_form


@factory
def closed_labels_kernel(shape: ClosedFormShape, backwards: bool, oriented: bool, cuda: bool) -> wp.Kernel:
    """Kernel of a class that labels poses as users have them; ``backwards``: it is solved from its tip.

    In: ``numbers`` of the arm (WORLD_FIELDS), the slack ``least`` below which nothing is reached, ``positions``
    (3 * count,) in the world [m], and where they are ``oriented`` ``quaternions`` (4 * count,), w first, of any length
    but 0; count is at least LANES. Out: ``labels`` (count,).
    """
    real = shape.real
    reals, bytes_ = wp.array(dtype=real), wp.array(dtype=wp.int8)

    @wp.func_native(_labels_body(shape, backwards, oriented))
    def block(
        task: wp.int32,
        count: wp.int32,
        least: real,
        numbers: reals,
        positions: reals,
        quaternions: reals,
        labels: bytes_,
    ): ...

    @wp.kernel(module="unique", module_options=CUDA_OPTIONS if cuda else LONG_OPTIONS, enable_backward=False)
    def closed_labels(
        # in
        count: wp.int32,
        least: real,
        numbers: wp.array(dtype=real),
        positions: wp.array(dtype=real),
        quaternions: wp.array(dtype=real),
        # out
        labels: wp.array(dtype=wp.int8),
    ):
        block(wp.tid(), count, least, numbers, positions, quaternions, labels)

    return closed_labels


@factory
def closed_bits_kernel(shape: ClosedFormShape, backwards: bool, cuda: bool) -> wp.Kernel:
    """Kernel of a class that labels one pose from many bases, of which it makes the frames; ``backwards``: as above.

    In: ``numbers`` of the arm and the pose (WORLD_FIELDS); ``least`` as above; ``motions`` (12 * turns,), a rotation by
    rows and a position [m] each, and ``positions`` (3 * places,) [m]. Base i has number first + step * i: its motion is
    that of the number modulo ``turns``, moved by the position of the quotient. Out: where the pose is reached the
    ``bit`` of ``reached`` (count,) is set, where it is out of reach that of ``missed``; count is at least LANES.
    """
    real = shape.real
    reals, bytes_ = wp.array(dtype=real), wp.array(dtype=wp.uint8)

    @wp.func_native(_bits_body(shape, backwards))
    def block(
        task: wp.int32,
        count: wp.int32,
        first: wp.int32,
        step: wp.int32,
        turns: wp.int32,
        bit: wp.int32,
        least: real,
        numbers: reals,
        motions: reals,
        positions: reals,
        reached: bytes_,
        missed: bytes_,
    ): ...

    @wp.kernel(module="unique", module_options=CUDA_OPTIONS if cuda else LONG_OPTIONS, enable_backward=False)
    def closed_bits(
        # in
        count: wp.int32,
        first: wp.int32,
        step: wp.int32,
        turns: wp.int32,
        bit: wp.int32,
        least: real,
        numbers: wp.array(dtype=real),
        motions: wp.array(dtype=real),
        positions: wp.array(dtype=real),
        # out
        reached: wp.array(dtype=wp.uint8),
        missed: wp.array(dtype=wp.uint8),
    ):
        block(wp.tid(), count, first, step, turns, bit, least, numbers, motions, positions, reached, missed)

    return closed_bits


@factory
def bits_by_base_kernel(cuda: bool) -> wp.Kernel:
    """Kernel that puts the bits of each base side by side, and lists the bases that leave some pose open.

    In: ``asked`` (bytes,), the bits of poses; ``bits``, rows of ``pitch`` bases: ``bytes`` of those that
    `closed_bits_kernel` has set of reached poses, and as many of missed ones. Out: ``reached`` and ``missed``
    (bases * bytes,), and in any order ``left``, as many as ``lefts`` (1,) counts.
    """
    bytes_ = wp.array(dtype=wp.uint8)

    @wp.kernel(module="unique", module_options=CUDA_OPTIONS if cuda else SHORT_OPTIONS, enable_backward=False)
    def bits_by_base(
        # in
        bytes: wp.int32,
        pitch: wp.int32,
        asked: bytes_,
        bits: bytes_,
        # out
        reached: bytes_,
        missed: bytes_,
        left: wp.array(dtype=wp.int32),
        lefts: wp.array(dtype=wp.int32),
    ):
        base, is_open = wp.tid(), wp.int32(0)
        for byte in range(bytes):
            reaches, misses = bits[byte * pitch + base], bits[(bytes + byte) * pitch + base]
            reached[base * bytes + byte] = reaches
            missed[base * bytes + byte] = misses
            is_open |= wp.int32(asked[byte]) & ~(wp.int32(reaches) | wp.int32(misses))
        if is_open != 0:
            left[wp.atomic_add(lefts, 0, 1)] = base

    return bits_by_base


def _bits_body(shape: ClosedFormShape, backwards: bool) -> str:
    """C++ of one task; lanes that two tasks take set the same bits."""
    rotation = [f"motions.data[12 * turn + {k}]" for k in range(9)]
    position = [f"(motions.data[12 * turn + {9 + r}] + positions.data[3 * place + {r}])" for r in range(3)]
    rows = ["const int number = first + step * at, place = number / turns, turn = number - turns * place;"]
    store = "reached.data[at] |= best > margin ? bit : 0; missed.data[at] |= best < least ? bit : 0;"
    rows += rows_of_pose(rotation, position, backwards, "moved")
    return body(shape, before=_whole_tasks(), first="begin", rows=rows, store=store)


def _whole_tasks() -> str:
    """Where the chain's world begins, and the first pose of a task: the last takes the last LANES poses."""
    own = [f"const real {name} = numbers.data[{k}];" for k, name in enumerate(WORLD_FIELDS) if k >= len(FIELDS)]
    return "\n".join([*own, f"const int begin = SMALLER(task * {LANES}, count - {LANES});", ""])


def _labels_body(shape: ClosedFormShape, backwards: bool, oriented: bool) -> str:
    """C++ of one task; the last takes the last LANES poses, some of which the one before it takes too."""
    turn, rotation = quaternion_rows("quaternions.data", "at") if oriented else ([], list("100010001"))
    position = [f"positions.data[3 * at + {r}]" for r in range(3)]
    rows = [*turn, *rows_of_pose(rotation, position, backwards, "moved")]
    store = f"labels.data[at] = best > margin ? {REACHABLE} : best < least ? {UNREACHABLE} : {UNDECIDED};"
    return body(shape, before=_whole_tasks(), first="begin", rows=rows, store=store)


def quaternion_rows(data: str, at: str) -> tuple[list[str], list[str]]:
    """What declares quaternion ``at`` of ``data``, of any length but 0, and its rotation's nine entries by rows."""
    names = ", ".join(f"q{name} = {data}[4 * {at} + {k}]" for k, name in enumerate("wxyz"))
    lines = [f"const real {names};", "const real two = 2 / (qw * qw + qx * qx + qy * qy + qz * qz);"]
    entries = [
        *("ONE - two * (qy * qy + qz * qz)", "two * (qx * qy - qw * qz)", "two * (qx * qz + qw * qy)"),
        *("two * (qx * qy + qw * qz)", "ONE - two * (qx * qx + qz * qz)", "two * (qy * qz - qw * qx)"),
        *("two * (qx * qz - qw * qy)", "two * (qy * qz + qw * qx)", "ONE - two * (qx * qx + qy * qy)"),
    ]
    return lines, entries


def rows_of_pose(rotation: list[str], position: list[str], backwards: bool, moved: str = "d") -> list[str]:
    """What declares t0 to t11, rotation by rows and position [reach], of a pose in the world; from the tip its inverse.

    ``rotation``: nine entries by rows; ``position`` [m], three; ``moved``: a name that is free there.
    """
    rows = []
    for r in range(3):
        for c in range(3):
            rows.append(f"const real t{3 * c + r if backwards else 3 * r + c} = {rotation[3 * r + c]};")
        rows.append(f"const real {moved}{r} = ({position[r]} - origin{r}) * scale;")
    for r in range(3):
        back = f"-(t{3 * r} * {moved}0 + t{3 * r + 1} * {moved}1 + t{3 * r + 2} * {moved}2)"
        rows.append(f"const real t{9 + r} = {back if backwards else f'{moved}{r}'};")
    return rows


_STORED = """postures.data[at] = found;
        slack.data[at] = best;
        flags.data[at] = flag;"""


def body(
    shape: ClosedFormShape,
    *,
    before: str = "",
    first: str = f"task * {LANES}",
    rows: list[str] | None = None,
    store: str = _STORED,
) -> str:
    """C++ of one task: what comes ``before`` its lanes, the ``first`` pose, `target_in_frame`'s rows, what is kept."""
    arm = {"nested": _nested, "general": _general, "parallel": _three_parallel}[shape.arm](shape)
    return f"""{closed_form_prelude(shape.real)}{before}#ifndef __CUDA_ARCH__
    #pragma clang loop vectorize(assume_safety) interleave_count(1)
    for (int lane = 0; lane < {LANES}; lane++) {{
        const int at = {first} + lane;
    #else
    {{
        const int at = task;
    #endif
        int found = 0, flag = 0, branch = 0, n1 = 1, n2 = 1, n3 = 1, n4 = 1, n5 = 1, n6 = 1;
        real best = -4;
        {target_in_frame(rows)}
        const real squared = px * px + py * py + pz * pz, around = px * px + py * py;
        {arm}
        {store}
    }}
    """


def closed_form_prelude(precision: type) -> str:
    """What the body of a task begins with: numbers of the arm by name, and slacks of joints."""
    real = "float" if precision is wp.float32 else "double"
    names = "\n".join(f"const real {name} = numbers.data[{k}];" for k, name in enumerate(FIELDS) if not _of_arc(name))
    first_arc = FIELDS.index(f"{ARC[0]}1")
    return f"""
    typedef {real} real;
    const real ONE = 1, ZERO = 0, TINY = {"1e-30f" if real == "float" else "1e-200"};
    const real margin = {MARGIN[precision]}, singular = {SINGULAR[precision]};
    #ifdef __CUDA_ARCH__
    {_extremes(real)}
    #define LARGER(a, b) larger(a, b)
    #define SMALLER(a, b) smaller(a, b)
    #define SIZE(a) ::fabs(a)
    #else
    #define LARGER(a, b) ((a) > (b) ? (a) : (b))
    #define SMALLER(a, b) ((a) < (b) ? (a) : (b))
    #define SIZE(a) ((a) < ZERO ? -(a) : (a))
    #endif
    #define ROOT(a) wp::sqrt(LARGER(a, ZERO))
    #define LEVER(a) SMALLER({STEEP} * (a), ONE)
    // An axis turned back by a joint, and by the angle to the axis before it.
    #define TURNED(x, y, c, s) {{ const real t_ = c * x + s * y; y = c * y - s * x; x = t_; }}
    #define TILTED(y, z, c, s) {{ const real t_ = c * y + s * z; z = c * z - s * y; y = t_; }}
    #define ROTATED(v, c, s, k) TURNED(v##0, v##1, c, s) TILTED(v##1, v##2, ca##k, sa##k)
    {names}
    const real* __restrict arcs = numbers.data + {first_arc};
    auto hinge = [&](int joint, real c, real s, int& n) -> real {{
        const real* arc = arcs + {len(ARC)} * (joint - 1);
        const real along = c * arc[0] + s * arc[1], aside = s * arc[0] - c * arc[1];
        const real within = arc[2] * along - arc[3] * SIZE(aside);
        const real both = SMALLER(within, along), either = LARGER(within, along), slack = arc[4] > ZERO ? both : either;
        n = (int)arc[6] + (slack >= -margin ? 1 : 0);
        return LARGER(slack, arc[5]);
    }};
    auto slide = [&](int joint, real d, int& n) -> real {{
        const real* arc = arcs + {len(ARC)} * (joint - 1);
        const real low = d - arc[7], high = arc[8] - d;
        real slack = SMALLER(low, high);
        slack = SMALLER(slack, ONE);
        n = slack >= -margin ? 1 : 0;
        return slack;
    }};
    """


def _extremes(real: str) -> str:
    """The larger and the smaller of two on CUDA: of float32 one instruction, where a choice is two of half the rate.

    As with a choice what is not a number stays one, and its pose undecided.
    """
    found = []
    for name, instruction, sign in (("larger", "max", ">"), ("smaller", "min", "<")):
        chosen = f"a {sign} b ? a : b"
        asked = f'real c; asm("{instruction}.NaN.f32 %0, %1, %2;" : "=f"(c) : "f"(a), "f"(b)); return c;'
        lines = asked if real == "float" else f"return {chosen};"
        found.append(f"auto {name} = [](real a, real b) -> real {{ {lines} }};")
    return " ".join(found)


def _of_arc(name: str) -> bool:
    return name.rstrip("12345678") in ARC


def target_in_frame(rows: list[str] | None = None) -> str:
    """The rotation A and the centre p of the last axes, in the frame of axis 1; ``rows``: what declares t0 to t11."""
    lines = rows or [f"const real t{k} = targets.data[{k} * count + at];" for k in range(TARGET_ROWS)]
    for r in range(3):
        lines += [
            f"const real u{r}{c} = base{3 * r} * t{c} + base{3 * r + 1} * t{3 + c} + base{3 * r + 2} * t{6 + c};"
            for c in range(3)
        ]
        lines += [f"const real A{r}{c} = u{r}0 * tool{c} + u{r}1 * tool{3 + c} + u{r}2 * tool{6 + c};" for c in (0, 2)]
        lines.append(
            f"const real p{'xyz'[r]} = base{3 * r} * t9 + base{3 * r + 1} * t10 + base{3 * r + 2} * t11 + base{9 + r}"
            f" + u{r}0 * tool9 + u{r}1 * tool10 + u{r}2 * tool11;"
        )
    return "\n".join(lines)


def _nested(shape: ClosedFormShape) -> str:
    """Joint after joint: both roots of the first equation, and of the second for each."""
    first, second = (_joint_1, _joint_3) if shape.first == 1 else (_joint_3, _joint_1)
    return "".join(
        [
            *first(shape, 1, "first", None),
            *second(shape, 2, "second", "first"),
            """
            const real lever1 = LEVER(first_sure), lever_roots = lever1 * LEVER(second_sure);
            const real exists = SMALLER(first_exists, lever1 * second_exists);
            const real roots = SMALLER(first_there, second_there);
            """,
            _posture(shape),
            "}}",
        ]
    )


def _joint_1(shape: ClosedFormShape, k: int, name: str, known: str | None) -> Iterator[str]:
    """Loop over where equation ``k`` puts joint 1: (X, Y, Z), and its displacement D1 where it is a slide."""
    squares, e = shape.squares[k - 1], f"e{k}"
    constant = f"{'squared + ' if squares else ''}{e}_lz * pz + {e}_l0"
    if not shape.revolute[0]:
        constant += f" + {e}_lx * px + {e}_ly * py"
    value = f"({_right(shape, k) if known else 'ZERO'}) - ({constant})"
    yield f"const real {name}_value = {value};"
    if shape.revolute[0]:
        yield f"""
        const real {name}_at = {name}_value * {e}_left_scale;
        const real {name}_root = around - {name}_at * {name}_at;
        const real {name}_there = {name}_root * {e}_left_weight, {name}_half = ROOT({name}_root);
        const real {name}_exists = {name}_there * {e}_left_weight, {name}_sure = {name}_half * {e}_left_weight;
        #pragma unroll
        for (int b_{name} = 0; b_{name} < 2; b_{name}++) {{
            const real side = b_{name} ? -{name}_half : {name}_half;
            const real X = {name}_at * {e}_left_x - side * {e}_left_y, Y = {name}_at * {e}_left_y + side * {e}_left_x;
            const real Z = pz, D1 = ZERO;
        """
    else:
        slope = f"-({e}_lz{' + 2 * pz' if squares else ''})"
        yield _slide_roots(name, squares, slope, "D1")
        yield "const real X = px, Y = py, Z = pz - D1;"


def _joint_3(shape: ClosedFormShape, k: int, name: str, known: str | None) -> Iterator[str]:
    """Loop over where equation ``k`` puts joint 3: (c3, s3), and its displacement D3 where it is a slide."""
    squares, e = shape.squares[k - 1], f"e{k}"
    left = f"{e}_lz * pz + {e}_l0{' + squared' if squares else ''}"
    if known:
        left = f"{e}_lx * X + {e}_ly * Y + {e}_lz * Z + {e}_l0{' + (X * X + Y * Y + Z * Z)' if squares else ''}"
    elif not shape.revolute[0]:
        left += f" + {e}_lx * px + {e}_ly * py"
    yield f"const real {name}_value = {left};"
    if shape.revolute[2]:
        yield f"""
        const real {name}_at = {name}_value * {e}_right_scale;
        const real {name}_root = ONE - {name}_at * {name}_at;
        const real {name}_there = {name}_root * {e}_right_weight, {name}_half = ROOT({name}_root);
        const real {name}_exists = {name}_there * {e}_right_weight, {name}_sure = {name}_half * {e}_right_weight;
        #pragma unroll
        for (int b_{name} = 0; b_{name} < 2; b_{name}++) {{
            const real side = b_{name} ? -{name}_half : {name}_half;
            const real c3 = {name}_at * {e}_right_x - side * {e}_right_y;
            const real s3 = {name}_at * {e}_right_y + side * {e}_right_x;
            const real D3 = ZERO;
        """
    else:
        yield _slide_roots(name, squares, f"{e}_rc", "D3")
        yield "const real c3 = D3, s3 = ZERO;"


def _slide_roots(name: str, squares: int, slope: str, displacement: str) -> str:
    """Loop over the roots of squares * D² + slope * D = value."""
    if not squares:
        return f"""
        const real {name}_there = ONE, {name}_exists = ONE, {name}_sure = SIZE({slope});
        #pragma unroll
        for (int b_{name} = 0; b_{name} < 1; b_{name}++) {{
            const real {displacement} = {name}_value / ({slope});
        """
    return f"""
    const real {name}_middle = -({slope}) / 2, {name}_root = {name}_middle * {name}_middle + {name}_value;
    const real {name}_exists = SMALLER({name}_root, ONE), {name}_half = ROOT({name}_root);
    const real {name}_there = {name}_exists, {name}_sure = {name}_half;
    #pragma unroll
    for (int b_{name} = 0; b_{name} < 2; b_{name}++) {{
        const real {displacement} = {name}_middle + (b_{name} ? -{name}_half : {name}_half);
    """


def _right(shape: ClosedFormShape, k: int) -> str:
    """What equation ``k`` says of a joint 3 that stands at (c3, s3)."""
    if shape.revolute[2]:
        return f"e{k}_rc * c3 + e{k}_rs * s3"
    return f"e{k}_rc * D3{' + D3 * D3' if shape.squares[k - 1] else ''}"


def _posture(shape: ClosedFormShape) -> str:
    """Joints 1 and 2 of where 1 and 3 stand, then the wrist of a spherical one."""
    lines = [
        "const real gx = X - a1, gy = ca1 * Y + sa1 * Z;",
        "const real fx = fx0 + fxc * c3 + fxs * s3, fy = fy0 + fyc * c3 + fys * s3;",
        "real lever = lever_roots;",
    ]
    if shape.revolute[0]:
        lines += [
            "const real i1 = ONE / LARGER(around, TINY);",
            "const real c1 = (px * X + py * Y) * i1, s1 = (py * X - px * Y) * i1;",
            "const real slack1 = hinge(1, c1, s1, n1), stored_c1 = c1, stored_s1 = s1;",
        ]
    else:
        lines += [
            "const real c1 = turn_c1, s1 = turn_s1, stored_c1 = D1, stored_s1 = ZERO;",
            "const real slack1 = slide(1, D1, n1);",
        ]
    if shape.revolute[1]:
        lines += [
            "const real turned = fx * fx + fy * fy, i2 = ONE / LARGER(turned, TINY);",
            "const real c2 = (fx * gx + fy * gy) * i2, s2 = (fx * gy - fy * gx) * i2;",
            "lever *= LEVER(wp::sqrt(turned));",
            "const real slack2 = hinge(2, c2, s2, n2), stored_c2 = c2, stored_s2 = s2;",
        ]
    else:
        lines += [
            "const real c2 = turn_c2, s2 = turn_s2;",
            "const real D2 = (ca1 * Z - sa1 * Y) - (fz0 + fzc * c3 + fzs * s3);",
            "const real slack2 = slide(2, D2, n2), stored_c2 = D2, stored_s2 = ZERO;",
        ]
    if shape.revolute[2]:
        lines += [
            "const real slack3 = hinge(3, c3, s3, n3), stored_c3 = c3, stored_s3 = s3;",
            "const real c3r = c3 * delta_c + s3 * delta_s, s3r = s3 * delta_c - c3 * delta_s;",
        ]
    else:
        lines += [
            "const real slack3 = slide(3, D3, n3), stored_c3 = D3, stored_s3 = ZERO;",
            "const real c3r = turn_c3, s3r = turn_s3;",
        ]
    lines.append(
        """
        const real arm_slack = SMALLER(SMALLER(slack1, slack2), slack3);
        real v0 = A02, v1 = A12, v2 = A22, m0 = A00, m1 = A10, m2 = A20;
        ROTATED(v, c1, s1, 1) ROTATED(m, c1, s1, 1)
        ROTATED(v, c2, s2, 2) ROTATED(m, c2, s2, 2)
        ROTATED(v, c3r, s3r, 3) ROTATED(m, c3r, s3r, 3)
        """
    )
    last = """
        const bool family = across < singular;
        int n_sum;
        const real sign = c5 < ZERO ? -ONE : ONE;
        const real both = hinge(v2 > ZERO ? 7 : 8, sign * m0, sign * m1, n_sum);
        const real slack4 = hinge(4, c4, s4, n4), slack5 = hinge(5, c5, s5, n5), slack6 = hinge(6, c6, s6, n6);
        const real turned46 = SMALLER(slack4, slack6), lever6 = lever * LEVER(sine5);
        const real wrist = family ? lever * SMALLER(slack5, both)
            : SMALLER(lever * root5, lever6 * SMALLER(slack5, turned46));
        const real whole = SMALLER(SMALLER(exists, lever * arm_slack), wrist);
        const real plain = SMALLER(SMALLER(roots, arm_slack), family ? SMALLER(slack5, both)
            : SMALLER(root5, SMALLER(slack5, turned46)));
        const bool first_of_family = !(family && b_wrist), counted = plain >= -margin && first_of_family;
        best = LARGER(best, whole);
        found += counted ? n1 * n2 * n3 * n5 * (family ? 1 : n4 * n6) : 0;
        const real least = family ? lever : lever6;
        const bool doubtful = least * least < singular;
        flag |= counted ? (family ? FAMILY_ : 0) | (doubtful ? DOUBTFUL_ : 0) : 0;
    """
    stored = ["stored_c1", "stored_s1", "stored_c2", "stored_s2", "stored_c3", "stored_s3"]
    stored += ["(family ? sign * m0 : c4)", "(family ? sign * m1 : s4)", "c5", "s5"]
    stored += [
        "(family ? (v2 > ZERO ? 4 : -4) : c6)",
        "(family ? ZERO : s6)",
        "(first_of_family ? plain : real(-4))",
        "(first_of_family ? (counted ? (family ? ZERO : lever6) : whole) : real(-4))",
    ]
    return "\n".join(lines) + wrist_postures(last + _store(shape, stored))


def wrist_postures(last: str) -> str:
    """Both postures of a wrist: v is the column of axis 6, m that of x, seen from the link before it; then ``last``."""
    text = """
        // Rz(q4) Rx(alpha4) Rz(q5) Rx(alpha5) Rz(q6): its last column tells q5, then q4; the first q6.
        const real across = v0 * v0 + v1 * v1, c45 = ca4 * ca5, s45 = sa4 * sa5;
        // x4² is what y4² leaves of the angle between axes 4 and 6, as certain as that where they are almost in line;
        // -4 is the least, but for a centre so close to axis 1 that joint 1 does not come out as a turn.
        const real is45 = ONE / s45, c5 = (c45 - v2) * is45, y4 = -ca4 * c5 * sa5 - sa4 * ca5;
        const real left5 = (across - y4 * y4) * (sa4 * sa4), root5 = LARGER(left5, real(-4));
        const real sine5 = ROOT(root5), half5 = sine5 * SIZE(is45);
        const real i46 = ONE / LARGER(across, TINY);
        #pragma unroll
        for (int b_wrist = 0; b_wrist < 2; b_wrist++) {
            const real s5 = b_wrist ? -half5 : half5;
            const real x4 = s5 * sa5;
            const real c4 = (x4 * v0 + y4 * v1) * i46, s4 = (x4 * v1 - y4 * v0) * i46;
            const real y0 = c4 * m0 + s4 * m1, y1 = c4 * m1 - s4 * m0;
            const real z1 = ca4 * y1 + sa4 * m2, z2 = ca4 * m2 - sa4 * y1;
            const real c6 = c5 * y0 + s5 * z1, s6 = ca5 * (c5 * z1 - s5 * y0) + sa5 * z2;
    """
    return text + last.replace("FAMILY_", str(FAMILY)).replace("DOUBTFUL_", str(DOUBTFUL)) + "}"


def _store(shape: ClosedFormShape, rows: list[str]) -> str:
    """The posture of a branch, which is the next one."""
    if not shape.keep:
        return ""
    lines = [f"place[{r} * count] = {value};" for r, value in enumerate(rows)]
    place = f"real* place = kept.data + branch * ({POSTURE_ROWS} * count) + at; branch++;"
    return "\n".join(["{", place, *lines, "}"])


def _three_parallel(shape: ClosedFormShape) -> str:
    """Joint 1 puts the meeting point of axes 5 and 6 into its plane; the wrist is (q2 + q3 + q4, q5, q6)."""
    if shape.revolute[0]:
        head = """
        const real in_plane = (ca1 * pz - plane) / sa1, root1 = around - in_plane * in_plane, half1 = ROOT(root1);
        const real exists1 = root1 * (sa1 * sa1), i1 = ONE / LARGER(around, TINY);
        const real sure1 = LEVER(half1 * SIZE(sa1));
        #pragma unroll
        for (int b_one = 0; b_one < 2; b_one++) {
            const real X = b_one ? -half1 : half1, Y = in_plane, Z = pz;
            const real c1 = (px * X + py * Y) * i1, s1 = (py * X - px * Y) * i1;
            const real slack1 = hinge(1, c1, s1, n1), stored_c1 = c1, stored_s1 = s1;
        """
    else:
        head = """
        const real exists1 = ONE, sure1 = LEVER(SIZE(ca1));
        {
            const real D1 = pz - (plane + sa1 * py) / ca1;
            const real X = px, Y = py, Z = pz - D1, c1 = turn_c1, s1 = turn_s1;
            const real slack1 = slide(1, D1, n1), stored_c1 = D1, stored_s1 = ZERO;
        """
    head += """
            const real gx = X - a1, gy = ca1 * Y + sa1 * Z;
            real v0 = A02, v1 = A12, v2 = A22, m0 = A00, m1 = A10, m2 = A20;
            ROTATED(v, c1, s1, 1) ROTATED(m, c1, s1, 1)
    """
    last = """
        const real slack5 = hinge(5, c5, s5, n5), slack6 = hinge(6, c6, s6, n6);
        const real ux = gx - (c4 * a4 - s4 * b4), uy = gy - (s4 * a4 + c4 * b4), far = ux * ux + uy * uy;
        const real i23 = ONE / (2 * a2 * a3), c3 = (far - a2 * a2 - a3 * a3) * i23;
        const real root3 = ONE - c3 * c3, half3 = ROOT(root3), iu = ONE / LARGER(far, TINY);
        const real there3 = root3 * weight3, exists3 = there3 * weight3;
        // Where links 2 and 3, of one length, lie on each other, the sine of joint 3 is as small as the way left to 4.
        const real lever5 = sure1 * LEVER(sine5), lever3 = lever5 * LEVER(half3 * weight3);
        #pragma unroll
        for (int b_three = 0; b_three < 2; b_three++) {
            const real s3 = b_three ? -half3 : half3, along = a2 + a3 * c3, aside = a3 * s3;
            const real c2 = (along * ux + aside * uy) * iu, s2 = (along * uy - aside * ux) * iu;
            const real c23 = c2 * c3 - s2 * s3, s23 = s2 * c3 + c2 * s3;
            const real c4_ = c4 * c23 + s4 * s23, s4_ = s4 * c23 - c4 * s23;
            const real slack234 = SMALLER(SMALLER(hinge(2, c2, s2, n2), hinge(3, c3, s3, n3)), hinge(4, c4_, s4_, n4));
            const real wrist = SMALLER(slack5, slack6);
            const real whole = SMALLER(SMALLER(exists1, sure1 * SMALLER(slack1, root5)),
                SMALLER(lever5 * SMALLER(wrist, exists3), lever3 * slack234));
            const real roots = SMALLER(SMALLER(exists1, root5), there3);
            const real plain = SMALLER(SMALLER(roots, slack1), SMALLER(wrist, slack234));
            const bool counted = plain >= -margin;
            best = LARGER(best, whole);
            found += counted ? n1 * n2 * n3 * n4 * n5 * n6 : 0;
            flag |= counted && lever3 * lever3 < singular ? DOUBTFUL_ : 0;
            STORE
        }
    """
    stored = ["stored_c1", "stored_s1", "c2", "s2", "c3", "s3", "c4_", "s4_", "c5", "s5", "c6", "s6", "plain"]
    stored.append("(counted ? lever3 : whole)")
    return head + wrist_postures(last.replace("STORE", _store(shape, stored))) + "}"


def _general(shape: ClosedFormShape) -> str:
    """Joint 3 where the conic that both equations leave, with joint 1's circle, meets the circle of joint 3."""
    return (
        """
        // x' Q x = 0 for x = (c3, s3, 1): X² + Y² less what they are.
        const real v1_ = squared + e1_lz * pz + e1_l0, v2_ = e2_lz * pz + e2_l0;
        const real told = SMALLER(SMALLER(e1_lx * e1_lx, e2_ly * e2_ly), ONE), told_root = ROOT(told);
        // (X, Y) = (right - value) / left: e1 holds X alone, e2 Y alone.
        const real lx_ = ONE / e1_lx, ly_ = ONE / e2_ly;
        const real Xc = e1_rc * lx_, Xs = e1_rs * lx_, X0 = -v1_ * lx_;
        const real Yc = e2_rc * ly_, Ys = e2_rs * ly_, Y0 = -v2_ * ly_;
        const real q00 = Xc * Xc + Yc * Yc, q01 = Xc * Xs + Yc * Ys, q11 = Xs * Xs + Ys * Ys;
        const real q02 = Xc * X0 + Yc * Y0, q12 = Xs * X0 + Ys * Y0, q22 = X0 * X0 + Y0 * Y0 - around;
        // (X, Y) runs about (X0, Y0), at most so far from it, and must meet the circle of joint 1.
        const real middle_ = ROOT(q22 + around), far_ = ROOT(q00 + q11), joint1 = ROOT(around);
        const real none_meet = SMALLER(far_ - SIZE(middle_ - joint1), ZERO) * told_root;
        """
        + _CONICS
        + """
                const real X = Xc * c3 + Xs * s3 + X0, Y = Yc * c3 + Ys * s3 + Y0, Z = pz, D1 = ZERO, D3 = ZERO;
                // Where Newton's steps have not come to rest nothing is certain, but that circles apart do not meet.
                const real settled = SIZE(off) < margin * LARGER(SIZE(slope), ONE) ? ONE : none_meet;
                const real exists = SMALLER(line * told, settled);
                const real roots = SMALLER(line, settled);
                const real half_ = settled < ONE ? ZERO : across_ * told_root;
                const real lever_roots = LEVER(SMALLER(half_, SIZE(slope))) * LEVER(joint1);
        """
        + _posture(shape)
        + "}}"
    )


# A member of the pencil Q + x diag(1, 1, -1) that is two lines, which meet the circle where the conic does.
_CONICS = """
        const real minor = q00 * q11 - q01 * q01, trace = q00 + q11, u2 = q02 * q02 + q12 * q12;
        const real k2 = trace - q22, k1 = minor - trace * q22 + u2;
        const real k0 = -(minor * q22 - (q11 * q02 * q02 - 2 * q01 * q02 * q12 + q00 * q12 * q12));
        const real third = ONE / 3, shift = -k2 * third, P = k1 - k2 * k2 * third;
        const real R = 2 * k2 * k2 * k2 * (third * third * third) - k2 * k1 * third + k0, size_R = SIZE(R);
        // The root farthest from 0 of y³ + P y + R, by Newton's steps from beyond it.
        real y = ROOT(-P) + (size_R < ONE ? wp::sqrt(wp::sqrt(size_R)) : wp::sqrt(size_R));
        #pragma unroll
        for (int step = 0; step < 14; step++) {
            const real rise = 3 * y * y + P;
            y = y - ((y * y + P) * y - size_R) / LARGER(rise, TINY);
        }
        y = R > ZERO ? -y : y;
        const real apart = -3 * y * y - 4 * P, half = ROOT(apart);
        const real x0 = y + shift, x1 = (half - y) / 2 + shift, x2 = (-half - y) / 2 + shift;
        // Real lines: the sum of principal minors is below 0.
        #define MINORS(x) ((q00 + x) * (q11 + x) - q01 * q01 + (q00 + x) * (q22 - x) - q02 * q02 \\
            + (q11 + x) * (q22 - x) - q12 * q12)
        const real none = real(1e30), h0 = MINORS(x0);
        const real h1 = apart < ZERO ? none : MINORS(x1), h2 = apart < ZERO ? none : MINORS(x2);
        const real x = h0 < h1 ? (h0 < h2 ? x0 : x2) : (h1 < h2 ? x1 : x2);
        const real d0 = q00 + x, d1 = q11 + x, d2 = q22 - x;
        // Their meeting point p, p p' = -adj: by its largest entry.
        const real b00 = q12 * q12 - d1 * d2, b11 = q02 * q02 - d0 * d2, b22 = q01 * q01 - d0 * d1;
        const real b01 = q01 * d2 - q12 * q02, b02 = d1 * q02 - q01 * q12, b12 = d0 * q12 - q01 * q02;
        const bool by0 = b00 >= b11 && b00 >= b22, by1 = !by0 && b11 >= b22;
        const real largest = by0 ? b00 : (by1 ? b11 : b22), ip = ONE / wp::sqrt(LARGER(largest, TINY));
        const real p0 = (by0 ? b00 : (by1 ? b01 : b02)) * ip, p1 = (by0 ? b01 : (by1 ? b11 : b12)) * ip;
        const real p2 = (by0 ? b02 : (by1 ? b12 : b22)) * ip;
        // Rows and columns of C + [p]x are the two lines.
        const real r01 = q01 - p2, r02 = q02 + p1, r10 = q01 + p2, r12 = q12 - p0, r20 = q02 - p1, r21 = q12 + p0;
        #define LARGEST(a, b, c) LARGER(LARGER(SIZE(a), SIZE(b)), SIZE(c))
        const real row0 = LARGEST(d0, r01, r02), row1 = LARGEST(r10, d1, r12), row2 = LARGEST(r20, r21, d2);
        const bool is0 = row0 >= row1 && row0 >= row2, is1 = !is0 && row1 >= row2;
        const real column0 = LARGEST(d0, r10, r20), column1 = LARGEST(r01, d1, r21), column2 = LARGEST(r02, r12, d2);
        const bool of0 = column0 >= column1 && column0 >= column2, of1 = !of0 && column1 >= column2;
        #pragma unroll
        for (int b_line = 0; b_line < 2; b_line++) {
            const real l0 = b_line ? (of0 ? d0 : (of1 ? r01 : r02)) : (is0 ? d0 : (is1 ? r10 : r20));
            const real l1 = b_line ? (of0 ? r10 : (of1 ? d1 : r12)) : (is0 ? r01 : (is1 ? d1 : r21));
            const real l2 = b_line ? (of0 ? r20 : (of1 ? r21 : d2)) : (is0 ? r02 : (is1 ? r12 : d2));
            const real il = ONE / wp::sqrt(LARGER(l0 * l0 + l1 * l1, TINY));
            const real n0 = l0 * il, n1_ = l1 * il, away = l2 * il;
            const real line = ONE - away * away, across_ = ROOT(line);
            #pragma unroll
            for (int b_side = 0; b_side < 2; b_side++) {
                const real side = b_side ? -across_ : across_;
                real c3 = -away * n0 - side * n1_, s3 = side * n0 - away * n1_;
                const real unit = ONE / wp::sqrt(LARGER(c3 * c3 + s3 * s3, TINY));
                c3 *= unit; s3 *= unit;
                real off, slope;
                #pragma unroll
                for (int step = 0; step < 3; step++) {
                    off = (q00 * c3 + 2 * q01 * s3 + 2 * q02) * c3 + (q11 * s3 + 2 * q12) * s3 + q22;
                    slope = 2 * ((q01 * c3 + q11 * s3 + q12) * c3 - (q00 * c3 + q01 * s3 + q02) * s3);
                    if (step < 2) {
                        const real by = SIZE(slope) > 4 * SIZE(off) ? -off / slope : ZERO;
                        const real moved = c3 - by * s3, up = s3 + by * c3;
                        const real again = ONE / wp::sqrt(moved * moved + up * up);
                        c3 = moved * again; s3 = up * again;
                    }
                }
"""
