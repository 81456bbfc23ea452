"""Tables of the robot and material libraries, from their files."""

import tomllib
from collections.abc import Iterator

from . import repository


def entries(folder: str) -> Iterator[tuple[str, str, dict]]:
    """Name, path and content of each file of a library."""
    for path in repository.inside(folder):
        if path.endswith(".toml"):
            yield path.removeprefix(folder + "/").removesuffix(".toml"), path, tomllib.loads(repository.read(path) or "")


def cell(value: object) -> str:
    """A value in a table; empty where it is missing."""
    return "" if value is None else str(value).replace("|", "\\|").replace("\n", " ")


def table(columns: list[str], rows: list[list[object]]) -> str:
    """A table in Markdown; columns whose title ends in a unit in brackets are numbers."""
    rule = ["---:" if title.endswith(")") else "---" for title in columns]
    lines = [columns, rule, *([cell(value) for value in row] for row in rows)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines) + "\n"


def cited(sources: dict) -> str:
    """The sources of a file, one an item."""
    return "\n".join(f"- *{key}*: {source['what']}. {source['where']}. Licence: {source['licence']}" for key, source in sources.items())


def compliance(robot: dict) -> str:
    """Where the joint compliances of a robot come from."""
    known = sorted({joint["compliance_source"] for joint in robot["joint"] if "compliance_source" in joint})
    return ", ".join(known) or "none"


def robots() -> dict[str, str]:
    """The page of the robot library."""
    rows, details = [], []
    for name, path, robot in entries("robots"):
        link = path.removeprefix("robots/")
        payload = robot.get("payload", {}).get("mass_kg")
        rows.append([f"[`{name}`](#{name.replace('/', '')})", robot["name"], len(robot["joint"]), payload, compliance(robot)])
        joints = [
            [joint["name"], *joint.get("limits_deg", [None, None]), joint.get("max_speed_deg_per_s"), joint.get("compliance_rad_per_n_m"), joint.get("compliance_u_rad_per_n_m")]
            for joint in robot["joint"]
        ]
        columns = ["joint", "lower limit (deg)", "upper limit (deg)", "largest speed (deg/s)", "compliance (rad/(N m))", "standard uncertainty (rad/(N m))"]
        note = " ".join(robot[key] for key in ("note", "description") if key in robot)
        details.append(f"## {name}\n\n**{robot['name']}**, [robot file]({link}). {note}\n\n{table(columns, joints)}\nSources:\n\n{cited(robot['sources'])}\n")
    head = (
        "# Robot library\n\nEach robot is named as in `robot = \"yaskawa/mh12\"` of a [study file](../docs/guide/study-file.md), and can be used in every command. "
        "Each number has a source. *Compliance* is the source of the joint compliances; where it is *none*, a study gives or assumes them "
        "([compliance classes](../docs/theory/compliance-classes.md)). Robots that are not in this list: [your own robot](../docs/guide/your-robot.md).\n\n"
    )
    return {"robots/README.md": head + table(["name", "robot", "joints", "payload (kg)", "compliance"], rows) + "\n" + "\n".join(details)}


def materials() -> dict[str, str]:
    """The page of the material library."""
    kienzle, mechanistic, details = [], [], []
    for name, path, material in entries("materials"):
        link = f"[`{name}`](#{name.replace('.', '')})"
        for one in material.get("kienzle", []):
            kienzle.append([link, one["condition"], one.get("group"), one["kc1_n_per_mm2"], one["mc_exponent"]])
        for one in material.get("mechanistic", []):
            keys = ("ktc_n_per_mm2", "krc_n_per_mm2", "kac_n_per_mm2", "kte_n_per_mm", "kre_n_per_mm", "kae_n_per_mm")
            mechanistic.append([link, one["tool"], *(one.get(key) for key in keys), one.get("note")])
        note = material.get("note", "")
        details.append(f"## {name}\n\n**{material['name']}**, [material file]({path.removeprefix('materials/')}). {note}\n\nSources:\n\n{cited(material['sources'])}\n")
    head = (
        "# Material library\n\nEach material is named as in `material = \"brass\"` of a [study file](../docs/guide/study-file.md); how its numbers are used: "
        "[cutting forces](../docs/theory/cutting.md). Each number has a source. Materials that are not in this list: [material file](../docs/guide/material-file.md).\n\n"
    )
    columns = ["material", "condition", "group", "kc1 (N/mm²)", "mc (-)"]
    shear = ["Ktc (N/mm²)", "Krc (N/mm²)", "Kac (N/mm²)", "Kte (N/mm)", "Kre (N/mm)", "Kae (N/mm)"]
    tables = f"## Specific cutting force\n\n{table(columns, kienzle)}\n## Shear and edge coefficients\n\n{table(['material', 'tool', *shear, 'note'], mechanistic)}\n"
    return {"materials/README.md": head + tables + "\n".join(details)}
