"""A histogram on a logarithmic scale, as SVG."""

from __future__ import annotations

import math
from collections.abc import Sequence
from html import escape

BINS, WIDTH, HEIGHT, FOOT = 24, 360, 120, 18


def histogram(title: str, values: Sequence[float], unit: str) -> str:
    """Counts of positive values between the least and the most of them; "" where there is none."""
    logs = [math.log10(value) for value in values if value > 0]
    if not logs:
        return ""
    low, high = min(logs), max(logs)
    counts = [0] * BINS
    for each in logs:
        counts[min(BINS - 1, int(BINS * (each - low) / ((high - low) or 1)))] += 1
    wide, scale = WIDTH / BINS, (HEIGHT - FOOT) / max(counts)
    bars = "".join(
        f'<rect x="{number * wide:.1f}" y="{HEIGHT - FOOT - count * scale:.1f}" '
        f'width="{wide - 1:.1f}" height="{count * scale:.1f}"/>'
        for number, count in enumerate(counts)
        if count
    )
    ends = "".join(
        f'<text x="{x}" y="{HEIGHT - 3}" text-anchor="{anchor}">{10**end:.3g} {escape(unit)}</text>'
        for x, anchor, end in ((0, "start", low), (WIDTH, "end", high))
    )
    drawing = f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" role="img">{bars}{ends}</svg>'
    return f"<figure><figcaption>{escape(title)}</figcaption>{drawing}</figure>"
