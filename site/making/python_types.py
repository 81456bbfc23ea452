"""Names of types in signatures of the Python reference: private ones by what they mean, public ones with a link."""

import re

# Names of the stub `_armill.pyi`.
PRIVATE = {
    "_Path": "str | PathLike",
    "_Floats": "NDArray[float64]",
    "_Integers": "NDArray[int64]",
    "_Flags": "NDArray[bool]",
    "_Numbers": "ArrayLike",
    "_Index": "int | tuple[int, ...]",
}
# Names of `armill/_types.py`; the page of the reference has a row for each.
PUBLIC = ("RobotLike", "StudyLike", "TableLike", "Poses", "Branch", "Progress", "Objective", "Component", "RankBy", "TurnOrder", "Path")
NAME = re.compile(r'<span class="n">(\w+)</span>')


def explained(content: str) -> str:
    """The content of a page of the reference with these names replaced or linked."""

    def named(match: re.Match) -> str:
        name = match[1]
        if name in PRIVATE:
            return f'<span class="n">{PRIVATE[name]}</span>'
        if name in PUBLIC:
            return f'<a href="index.html#types">{match[0]}</a>'
        return match[0]

    return NAME.sub(named, content)
