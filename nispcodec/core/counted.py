"""Counts as a sentence has them."""


def counted(number: int, noun: str) -> str:
    """`1 face`, `1,200 faces`, `2 vertices`: the noun in the singular comes in."""
    plural = noun.replace("vertex", "vertice") + "s"
    return f"{number:,} {noun if number == 1 else plural}"
