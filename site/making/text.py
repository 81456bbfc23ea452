"""Differences between the Markdown of GitHub, in which pages are written, and that of the generator."""

import re

FENCE = re.compile(r"^\s*(```|~~~)")
NESTED = re.compile(r"^ {2,3}(?=([-*]|\d+\.) )")
LINK = re.compile(r"(\]\()([^)\s]+)")
CODE = re.compile(r"(`+)(?!`).+?(?<!`)\1(?!`)")
MASK = re.compile("\0(\\d+)\0")


def is_code(lines: list[str]) -> list[bool]:
    """Which lines are in a fenced block, the fences included."""
    inside, flags = False, []
    for line in lines:
        fence = FENCE.match(line) is not None
        flags.append(inside or fence)
        inside ^= fence
    return flags


def nested(markdown: str) -> str:
    """Items of nested lists are indented by four blanks."""
    lines = markdown.split("\n")
    return "\n".join(line if code else NESTED.sub("    ", line) for line, code in zip(lines, is_code(lines)))


def with_links(markdown: str, change) -> str:
    """The text with the target of each link, outside code, replaced by `change(target)`."""
    lines = markdown.split("\n")

    def replaced(line: str) -> str:
        spans: list[str] = []

        def masked(span: re.Match) -> str:
            spans.append(span[0])
            return f"\0{len(spans) - 1}\0"

        line = LINK.sub(lambda link: link[1] + change(link[2]), CODE.sub(masked, line))
        return MASK.sub(lambda mask: spans[int(mask[1])], line)

    return "\n".join(line if code else replaced(line) for line, code in zip(lines, is_code(lines)))


def is_relative(target: str) -> bool:
    """Whether a link leads to a file of the repository."""
    return not re.match(r"[a-z]+:|#|//", target)
