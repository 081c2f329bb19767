"""A scatter plot with two logarithmic axes as SVG: every point tells its values when hovered."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

WIDTH, HEIGHT = 560, 360
LEFT, RIGHT, TOP, BOTTOM = 64, 12, 12, 40


@dataclass(frozen=True)
class Dot:
    """A point of the plot; `text` shows when the mouse is over it."""

    x: float
    y: float
    color: str
    text: str
    large: bool = False


@dataclass(frozen=True)
class Line:
    """A line through points, left to right."""

    points: Sequence[tuple[float, float]]
    color: str


class Axis:
    """From values to pixels along one axis."""

    def __init__(self, values: Sequence[float], start: float, end: float) -> None:
        logs = [math.log10(value) for value in values]
        margin = 0.05 * (max(logs) - min(logs)) or 0.1
        self.low, self.high = min(logs) - margin, max(logs) + margin
        self.start, self.end = start, end

    def __call__(self, value: float) -> float:
        """The pixel of a value."""
        share = (math.log10(value) - self.low) / (self.high - self.low)
        return self.start + share * (self.end - self.start)

    def ticks(self) -> list[float]:
        """1, 2 and 5 times powers of ten, of a wide range the powers alone."""
        steps = (1, 2, 5) if self.high - self.low < 3 else (1,)
        powers = range(math.floor(self.low), math.ceil(self.high) + 1)
        ticks = [step * 10.0**power for power in powers for step in steps]
        return [tick for tick in ticks if self.low <= math.log10(tick) <= self.high]


def chart(dots: Sequence[Dot], lines: Sequence[Line], x_name: str, y_name: str) -> str:
    """The SVG element; all values are positive."""
    across = Axis([dot.x for dot in dots], LEFT, WIDTH - RIGHT)
    up = Axis([dot.y for dot in dots], HEIGHT - BOTTOM, TOP)
    parts = [*_grid(across, up), *(_line(line, across, up) for line in lines)]
    parts += [_dot(dot, across, up) for dot in dots]
    parts.append(_label(WIDTH / 2, HEIGHT - 6, x_name))
    parts.append(_label(12, HEIGHT / 2, y_name, f' transform="rotate(-90 12 {HEIGHT / 2})"'))
    return f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}">{"".join(parts)}</svg>'


def _label(x: float, y: float, text: str, more: str = "") -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="middle"{more}>{escape(text)}</text>'


def _grid(across: Axis, up: Axis) -> list[str]:
    parts = []
    for tick in across.ticks():
        x = f"{across(tick):.1f}"
        parts.append(f'<path class="grid" d="M{x} {TOP}V{HEIGHT - BOTTOM}"/>')
        parts.append(_label(across(tick), HEIGHT - BOTTOM + 14, f"{tick:,.0f}"))
    for tick in up.ticks():
        y = up(tick)
        parts.append(f'<path class="grid" d="M{LEFT} {y:.1f}H{WIDTH - RIGHT}"/>')
        parts.append(f'<text x="{LEFT - 5}" y="{y + 4:.1f}" text-anchor="end">{tick:.0e}</text>')
    return parts


def _line(line: Line, across: Axis, up: Axis) -> str:
    path = "L".join(f"{across(x):.1f} {up(y):.1f}" for x, y in line.points)
    return f'<path class="line" stroke="{line.color}" d="M{path}"/>'


def _dot(dot: Dot, across: Axis, up: Axis) -> str:
    radius = 5 if dot.large else 2.6
    place = f'cx="{across(dot.x):.1f}" cy="{up(dot.y):.1f}" r="{radius}"'
    return f'<circle {place} fill="{dot.color}"><title>{escape(dot.text)}</title></circle>'
