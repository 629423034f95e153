"""Ranges of samples: shards of a plan."""

from wsrender.errors import InputError


def check_range(first: int, count: int, total: int, unit: int) -> None:
    """Raise InputError unless the samples first … first + count - 1 of a plan of ``total`` can be swept by themselves.

    They begin and end at multiples of the ``unit``, or at the plan's end: elsewhere samples would be lost, or counted
    twice, where ranges meet.
    """
    end = first + count
    if not 0 <= first <= end <= total or first % unit or (end % unit and end != total):
        raise InputError(
            "shards",
            f"{count} samples from sample {first} are not allowed: a shard of this plan begins and ends at multiples "
            f"of its shard_unit {unit}, or at the plan's end, {total}",
        )
