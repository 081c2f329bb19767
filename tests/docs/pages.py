"""The pages for users, and what stands in them."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


def prose(path: Path) -> str:
    """The page without code, tables, pictures and comments; a link is its text."""
    text = re.sub(r"```.*?```", "", path.read_text(encoding="utf-8"), flags=re.S)
    kept = [
        line
        for line in text.splitlines()
        if not re.match(r" {4}|\||!\[|<!--", line) or re.match(r" {4}[-*\d]", line)
    ]
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", "\n".join(kept))
    return re.sub(r"`[^`]*`", "CODE", text)


def sentences(path: Path) -> list[str]:
    """The sentences of headings, paragraphs and list items."""
    blocks = re.split(r"\n\s*\n|\n(?=[-*#] |\d+\. )", prose(path))
    joined = (" ".join(block.split()) for block in blocks)
    return [each for block in joined for each in re.split(r"(?<=[.:;?!])\s+", block) if each]


def commands(path: Path) -> list[str]:
    """The `nisp` command lines in code, without comments."""
    lines = path.read_text(encoding="utf-8").splitlines()
    found = [line.strip().split("  #")[0].strip() for line in lines if line.startswith("    nisp ")]
    return [line for line in found if "[OPTIONS]" not in line]


def links(path: Path) -> list[str]:
    """The files that a page points at, relative to its folder."""
    targets = re.findall(r"\]\(([^)\s]+)\)", path.read_text(encoding="utf-8"))
    return [
        target.split("#")[0] for target in targets if not re.match(r"https?:|#|mailto:", target)
    ]
