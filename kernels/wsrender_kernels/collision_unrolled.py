"""The filter of `collision` written out for one robot: on CUDA what is indexed as data would lie in memory.

Numbers of the program are literals of the code, as float32 holds them; frames, capsules and tests are named values.
"""

from typing import Any

import numpy as np

NOTHING = 1e-12  # of a unit vector's coordinates: left out, since float32 is off by more
MOST_TESTS = 1500  # NVRTC takes about 10 ms for each; a robot among more than that is read as data


def unrolled(program: Any, words: int) -> str | None:
    """Body of the filter for one sample ``q``: ``masks`` (words,), ``hit`` by reason; None where it would be too long.

    ``program``: a `wsrender.collision.program.Program`.
    """
    if program.pairs[:, 2].sum() + program.planes[:, 2].sum() > MOST_TESTS:
        return None
    written = _Written(program)
    for i, (low, high) in enumerate(zip(program.lower, program.upper, strict=True)):
        slack = np.float32(4e-6) * (np.float32(1) + high - low)
        written.add(f"inside &= q[{i}] >= {_f(low - slack)} && q[{i}] <= {_f(high + slack)};")
    for pair, first, count in program.pairs.tolist():
        written.capsule_tests(pair, range(first, first + count))
    for pair, first, count in program.planes.tolist():
        written.plane_tests(pair, range(first, first + count))
    for table in range(len(program.tables)):
        written.table(table)
    declared = f"unsigned masks[{words}] = {{0u}}; bool hit[2] = {{false, false}}, inside = true;"
    return "\n".join([declared, *written.lines])


class _Written:
    """Lines of code; frames and capsules are written before what uses them first."""

    def __init__(self, program: Any):
        self.program, self.lines = program, []
        self._frames: set[int] = {program.root}
        self._capsules: set[int] = set()

    def add(self, line: str) -> None:
        self.lines.append(line)

    def axes(self, frame: int, row: int) -> list[str]:
        """Row of a frame's rotation."""
        return [_f(axis == "xyz"[row]) if frame == self.program.root else f"{axis}{frame}_{row}" for axis in "xyz"]

    def origin(self, frame: int, row: int) -> str:
        return "0.f" if frame == self.program.root else f"o{frame}_{row}"

    def frame(self, number: int) -> None:
        """Frame of joint ``number`` - 1, 0 the base; all are taken from the program's root."""
        if number in self._frames:
            return
        self._frames.add(number)
        self.frame(number - 1)
        t, source = self.program.joints[number - 1], self.program.sources[number - 1]
        j = number
        self.add(f"float a{j} = {_f(t[12])} * q[{source}] + {_f(t[13])}, s{j} = 0.f, c{j} = 1.f;")
        if t[14]:
            self.add(f"sincos_of(a{j}, s{j}, c{j});")
        for row in range(3):
            before = self.axes(j - 1, row)
            x, y, z = (_sum(zip(t[k:9:3], before, strict=True)) for k in range(3))
            at = _sum([(1, self.origin(j - 1, row)), *zip(t[9:12], before, strict=True)])
            slide = "" if t[14] else f" + a{j} * z{j}_{row}"
            self.add(f"float u{j}_{row} = {x}, v{j}_{row} = {y}, z{j}_{row} = {z};")
            self.add(f"float x{j}_{row} = c{j} * u{j}_{row} + s{j} * v{j}_{row};")
            self.add(f"float y{j}_{row} = c{j} * v{j}_{row} - s{j} * u{j}_{row}, o{j}_{row} = {at}{slide};")

    def capsule(self, number: int) -> None:
        """Middle m and unit axis h of a capsule."""
        if number in self._capsules:
            return
        self._capsules.add(number)
        frame = int(self.program.capsule_frame[number])
        self.frame(frame)
        numbers = self.program.capsules[number]
        for row in range(3):
            axes = self.axes(frame, row)
            middle = _sum([(1, self.origin(frame, row)), *zip(numbers[:3], axes, strict=True)])
            self.add(
                f"float m{number}_{row} = {middle}, h{number}_{row} = {_sum(zip(numbers[3:], axes, strict=True))};"
            )

    def verdict(self, pair: int, near: float, hit: float, value: str, least: float) -> None:
        """What a test says of its pair; a bound at or below ``least`` is never undercut."""
        if near > least:
            self.add(f"if ({value} - {_f(near)} < 0.f) masks[{pair >> 5}] |= {1 << (pair & 31)}u;")
        if hit > least:
            self.add(f"hit[{int(self.program.pair_numbers[pair, 1])}] |= {value} - {_f(hit)} < 0.f;")

    def capsule_tests(self, pair: int, tests: range) -> None:
        for test in tests:
            a, b = self.program.tests[test].tolist()
            self.capsule(a)
            self.capsule(b)
            most_s, most_w, near, hit, _ = self.program.test_numbers[test]
            lines = [f"float r{k} = m{a}_{k} - m{b}_{k};" for k in range(3)]
            if most_s + most_w > 0:
                dots = {"b": (f"h{a}_", f"h{b}_"), "c": (f"h{a}_", "r"), "f": (f"h{b}_", "r")}
                for name, (first, second) in dots.items():
                    lines.append(f"float {name} = {' + '.join(f'{first}{k} * {second}{k}' for k in range(3))};")
                lines += [
                    f"float s = clamped((b * f - c) / (1.000001f - b * b), {_f(most_s)});",
                    f"float w = clamped(b * s + f, {_f(most_w)});",
                    f"s = clamped(b * w - c, {_f(most_s)});",
                    *(f"r{k} += h{a}_{k} * s - h{b}_{k} * w;" for k in range(3)),
                ]
            self.add("{ " + " ".join([*lines, "float d2 = r0 * r0 + r1 * r1 + r2 * r2;"]))
            self.verdict(pair, near, hit, "d2", 0.0)
            self.add("}")

    def plane_tests(self, pair: int, tests: range) -> None:
        for test in tests:
            a, b = self.program.tests[test].tolist()
            self.capsule(a)
            self.capsule(b)
            height = " + ".join(f"(m{b}_{k} - m{a}_{k}) * h{a}_{k}" for k in range(3))
            along = " + ".join(f"h{b}_{k} * h{a}_{k}" for k in range(3))
            _, most, near, hit, _ = self.program.test_numbers[test]
            self.add(f"{{ float d = {height} - {_f(most)} * wp::abs({along});")
            self.verdict(pair, near, hit, "d", -np.inf)
            self.add("}")

    def table(self, number: int) -> None:
        pair, i, j, first = self.program.tables[number].tolist()
        low, per, low_2, per_2 = self.program.table_numbers[number]
        columns, last = int(self.program.table_columns[number]), self.program.columns - 1
        self.add(
            f"{{ float x = wp::min(wp::max((q[{i}] - {_f(low)}) * {_f(per)}, 0.f), {_f(last)});"
            f" float y = wp::min(wp::max((q[{j}] - {_f(low_2)}) * {_f(per_2)}, 0.f), {_f(columns - 1)});"
            f" int cell = (int)x * {columns} + (int)y;"
            f" unsigned label = (program.table_words.data[{first} + (cell >> 4)] >> ((cell & 15) * 2)) & 3u;"
            f" if (label == 2u) masks[{pair >> 5}] |= {1 << (pair & 31)}u;"
            f" hit[{int(self.program.pair_numbers[pair, 1])}] |= label == 1u; }}"
        )


def _f(value: Any) -> str:
    """A literal that is read as the float32 that it was."""
    text = repr(float(np.float32(value)))
    return f"{text}f" if value >= 0 else f"({text}f)"


def _sum(terms: Any) -> str:
    """Sum of factors times names; what is nothing is left out."""
    parts = [
        name if np.float32(factor) == 1 else f"{_f(factor)} * {name}"
        for factor, name in terms
        if abs(factor) > NOTHING and name not in ("0.f", "0.0f")
    ]
    return " + ".join(parts) or "0.f"
