"""Numbers with their errors and units."""

from __future__ import annotations

import math
from typing import Any


class Value(float):
    """A number in SI with its estimated error: it computes like a float.

    >>> Value(-0.0115, error=2e-6, unit="m", time=6.95)
    -0.0115 ± 2e-06 m
    """

    __slots__ = ("error", "model", "time", "unit")

    error: float | None
    """Estimated error of mesh and steps, in the unit of the value; ``None`` where it is not known."""
    unit: str
    """Unit, as in the files of the program; empty for a number."""
    time: float | None
    """Time at which it occurs [s]."""
    model: float | None
    """Difference from the value of the exact coupling, where that was computed."""

    def __new__(
        cls,
        value: float,
        error: float | None = None,
        unit: str = "",
        time: float | None = None,
        model: float | None = None,
    ) -> Value:
        self = super().__new__(cls, value)
        self.error = error
        self.unit = unit
        self.time = time
        self.model = model
        return self

    def _short(self) -> str:
        """The digits that its error leaves, and the error."""
        if self.error is None or not math.isfinite(self) or not math.isfinite(self.error):
            return f"{float(self):.6e}"
        if self.error == 0.0 or self == 0.0:
            return f"{float(self):.6g} ± {self.error:.0e}"
        digits = math.floor(math.log10(abs(self))) - math.floor(math.log10(self.error)) + 1
        return f"{float(self):.{min(max(digits, 1), 15)}g} ± {self.error:.0e}"

    def __repr__(self) -> str:
        parts = [float.__repr__(self)]
        if self.error is not None:
            parts.append(f"± {self.error:.1g}")
        if self.unit:
            parts.append(self.unit)
        return " ".join(parts)

    __str__ = __repr__

    def __format__(self, spec: str) -> str:
        return float.__format__(self, spec) if spec else repr(self)

    def __reduce__(self) -> tuple[Any, ...]:
        return Value, (float(self), self.error, self.unit, self.time, self.model)
