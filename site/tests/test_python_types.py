"""The names of types in signatures are those of the package."""

import re
import unittest

from making import python_types, repository

ALIAS = re.compile(r"^(\w+): TypeAlias", re.MULTILINE)
PACKAGE = "python/src/armill"


class PythonTypes(unittest.TestCase):
    def test_every_private_name_of_the_stub_is_explained(self):
        names = ALIAS.findall(repository.read(f"{PACKAGE}/_armill.pyi"))
        self.assertEqual(sorted(names), sorted(python_types.PRIVATE))

    def test_every_public_name_has_a_row(self):
        names = ALIAS.findall(repository.read(f"{PACKAGE}/_types.py"))
        self.assertEqual(sorted(names), sorted(python_types.PUBLIC))
        page = repository.read("site/pages/python/README.md")
        for name in names:
            self.assertIn(f"| `{name}` |", page)

    def test_every_public_object_of_the_package_is_in_the_reference(self):
        pages = "".join(repository.read(path) for path in repository.inside("site/pages/python"))
        for module in ("armill", "armill.plot", "armill.interop", "armill.scale"):
            text = repository.read(f"python/src/{module.replace('.', '/')}/__init__.py")
            names = re.findall(r'^    "([A-Za-z]\w*)",$', text, re.MULTILINE) or re.findall(r'"(\w+)"', text.partition("__all__")[2])
            self.assertGreater(len(names), 3, module)
            for name in names:
                self.assertIn(f"::: {module}.{name}\n", pages)

    def test_names_are_replaced_and_linked(self):
        content = '<span class="n">_Floats</span> <span class="n">Poses</span> <span class="n">x</span>'
        expected = '<span class="n">NDArray[float64]</span> <a href="index.html#types"><span class="n">Poses</span></a> <span class="n">x</span>'
        self.assertEqual(python_types.explained(content), expected)
