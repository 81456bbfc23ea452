"""Run by `freecadcmd test_freecad.py`, with the command armill in ARMILL or on the path. Exits with 1 if a test fails."""

import os
import sys
import tempfile
import traceback
import unittest

import FreeCAD
import Part
import PathScripts.PathJob as PathJob
import PathScripts.PathProfile as PathProfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import armill_freecad

STUDY = """format = 1
robot = "fanuc/r2000ic"
tolerance_um = 100

[tool]
flange_from_tool_mm_deg = [0, 0, 260, 0, 0, 0]

[plane]
centre_mm = [1700, 200, 900]
tilt_deg = 90
half_size_mm = 150
step_mm = 50

[load]
cases_n = [[60, 0, 0], [0, 60, 0]]

[[analysis]]
kind = "path"
name = "contour"
program = { file = "contour.ngc" }
"""


def document():
    """A plate of 120 x 80 x 20 mm with a hole, a job with its contour."""
    made = FreeCAD.newDocument("plate")
    plate = made.addObject("Part::Feature", "Plate")
    plate.Shape = Part.makeBox(120, 80, 20).cut(Part.makeCylinder(4, 20, FreeCAD.Vector(30, 40, 0)))
    made.recompute()
    job = PathJob.Create("Job", [plate])
    profile = PathProfile.Create("Profile")
    top = next(i for i, face in enumerate(plate.Shape.Faces, 1) if face.CenterOfMass.z > 19.9)
    profile.Base = [(job.Model.Group[0], [f"Face{top}"])]
    profile.processHoles = True
    profile.setExpression("FinalDepth", None)
    profile.FinalDepth = 12.0
    profile.setExpression("StepDown", None)
    profile.StepDown = 4.0
    controller = job.Tools.Group[0]
    controller.HorizFeed, controller.VertFeed, controller.SpindleSpeed = "600 mm/min", "200 mm/min", 9000
    made.recompute()
    return made, job


class Macro(unittest.TestCase):
    def setUp(self):
        self.document, self.job = document()
        self.folder = tempfile.mkdtemp()
        self.study = os.path.join(self.folder, "study.toml")
        self.write(STUDY)

    def tearDown(self):
        FreeCAD.closeDocument(self.document.Name)

    def write(self, text):
        with open(self.study, "w", encoding="utf-8") as file:
            file.write(text)

    def test_path_in_colours(self):
        group, prediction = armill_freecad.show(self.job, self.study)
        levels = [each for each in group.Group if each.Name.startswith("Level")]
        self.assertGreater(len(levels), 3)
        # The contour is on the path of the job: two passes of 4 mm from the top of the stock, at the radius of the tool from the plate.
        radius = float(self.job.Tools.Group[0].Tool.Diameter) / 2
        passes = [each["at"] for each in prediction.points if round(each["at"][2], 3) in (17.0, 13.0)]
        self.assertAlmostEqual(min(x for x, _, _ in passes), -radius, places=5)
        self.assertAlmostEqual(max(y for _, y, _ in passes), 80 + radius, places=5)
        # The colours follow the deviations, and all of the length is drawn once.
        for level in levels:
            self.assertLess(level.FromUm, level.ToUm)
        drawn = sum(edge.Length for level in levels for edge in level.Shape.Edges)
        self.assertAlmostEqual(drawn, prediction.path["length_mm"], delta=0.001 * drawn)
        largest = max(each["deviation_um"] for each in prediction.points)
        self.assertAlmostEqual(largest, prediction.path["max_in_plane_um"], delta=0.001)
        self.assertAlmostEqual(levels[-1].ToUm, largest, delta=1e-6)
        worst = [each for each in group.Group if each.Name.startswith("Worst")]
        self.assertIn(f"{largest:.1f} um, line ", worst[0].Label)
        self.document.saveAs(os.path.join(self.folder, "plate.FCStd"))

    def test_again_replaces_the_group(self):
        armill_freecad.show(self.job, self.study)
        count = len(self.document.Objects)
        armill_freecad.show(self.job)
        self.assertEqual(len(self.document.Objects), count)

    def test_problems_are_texts(self):
        cases = [
            (STUDY.replace('"fanuc/r2000ic"', '"fanuc/none"'), "fanuc/none"),
            (STUDY.replace("[[analysis]]", "[[analysis"), "study.toml"),
            (STUDY.replace('kind = "path"', 'kind = "map"'), 'no analysis of kind "path"'),
        ]
        for text, words in cases:
            self.write(text)
            with self.assertRaises(armill_freecad.Problem) as found:
                armill_freecad.show(self.job, self.study)
            self.assertIn(words, str(found.exception))
        self.write(STUDY)
        with open(os.path.join(self.folder, "contour.ngc"), "w", encoding="utf-8") as file:
            file.write("G21\n")
        with self.assertRaises(armill_freecad.Problem) as found:
            armill_freecad.show(self.job, self.study)
        self.assertIn("was not written from FreeCAD", str(found.exception))
        with self.assertRaises(armill_freecad.Problem):
            armill_freecad.show(self.job, os.path.join(self.folder, "none.toml"))

    def test_out_of_reach(self):
        self.write(STUDY.replace("[1700, 200, 900]", "[2650, 0, 900]"))
        group, prediction = armill_freecad.show(self.job, self.study)
        self.assertTrue(any(each["deviation_um"] is None for each in prediction.points))
        self.assertTrue(any(each.Label == "not reached" for each in group.Group))


# freecadcmd runs this file as a module and does not pass its exit code on.
try:
    done = unittest.TextTestRunner(verbosity=2).run(unittest.defaultTestLoader.loadTestsFromTestCase(Macro))
    code = 0 if done.wasSuccessful() and done.testsRun else 1
except BaseException:
    traceback.print_exc()
    code = 1
sys.stdout.flush()
sys.stderr.flush()
os._exit(code)
