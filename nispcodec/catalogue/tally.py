"""How far a batch is: counts, pace, time left; for people and as OpenMetrics."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, field

from nispcodec.catalogue.job import Result

HOUR = 3600.0


@dataclass
class Tally:
    """Counts of one run; `hear` changes them.

    total     assets of the run
    done      written by it
    kept      of an earlier run, found as they were
    failed    given up
    retried   begun again
    running   at work
    in_bytes  of the inputs of what is done or kept, textures included; out_bytes: of the outputs
    """

    total: int
    done: int = 0
    kept: int = 0
    failed: int = 0
    retried: int = 0
    running: int = 0
    in_bytes: int = 0
    out_bytes: int = 0
    began: float = field(default_factory=time.monotonic)

    def hear(self, result: Result) -> None:
        """Count a result."""
        record = result.record
        if not record.done:
            self.failed += 1
            return
        if result.kept:
            self.kept += 1
        else:
            self.done += 1
        self.out_bytes += record.bytes.get("total", 0)
        self.in_bytes += record.saved + record.bytes.get("total", 0)

    @property
    def seconds(self) -> float:
        """Since the run began."""
        return time.monotonic() - self.began

    @property
    def left(self) -> int:
        """Assets that are neither done nor given up."""
        return self.total - self.done - self.kept - self.failed

    @property
    def hourly(self) -> float:
        """Assets an hour, those that were kept left out."""
        return HOUR * (self.done + self.failed) / max(self.seconds, 1e-9)

    @property
    def seconds_left(self) -> float:
        """As if the rest went at the same pace; infinite while none is done."""
        return HOUR * self.left / self.hourly if self.hourly else float("inf")

    @property
    def facts(self) -> dict[str, float]:
        """All that is known, by name; the time left only where it is."""
        known = {
            "total": self.total,
            "done": self.done,
            "kept": self.kept,
            "failed": self.failed,
            "retried": self.retried,
            "running": self.running,
            "saved_bytes": self.in_bytes - self.out_bytes,
            "seconds": round(self.seconds, 1),
            "assets_per_hour": round(self.hourly, 1),
        }
        return known | ({"seconds_left": round(self.seconds_left, 1)} if self.hourly else {})


METRICS: Mapping[str, tuple[str, str]] = {
    "assets": ("gauge", "Assets of the run."),
    "assets_done": ("counter", "Assets encoded and verified."),
    "assets_kept": ("counter", "Assets found done by an earlier run."),
    "assets_failed": ("counter", "Assets given up."),
    "assets_retried": ("counter", "Tries after the first."),
    "assets_running": ("gauge", "Assets at work."),
    "input_bytes": ("counter", "Bytes of the inputs of done assets, textures included."),
    "output_bytes": ("counter", "Bytes of their outputs."),
    "seconds": ("gauge", "Seconds since the run began."),
}


def open_metrics(tally: Tally) -> str:
    """The tally as OpenMetrics text, for a collector that reads files."""
    values = {
        "assets": tally.total,
        "assets_done": tally.done,
        "assets_kept": tally.kept,
        "assets_failed": tally.failed,
        "assets_retried": tally.retried,
        "assets_running": tally.running,
        "input_bytes": tally.in_bytes,
        "output_bytes": tally.out_bytes,
        "seconds": round(tally.seconds, 1),
    }
    lines = []
    for name, (kind, said) in METRICS.items():
        metric = f"nisp_batch_{name}"
        sample = f"{metric}_total" if kind == "counter" else metric
        lines += [f"# TYPE {metric} {kind}", f"# HELP {metric} {said}", f"{sample} {values[name]}"]
    return "\n".join([*lines, "# EOF"]) + "\n"
