"""Samples of uncertain inputs, covariances and shares of the variance: against numpy, scipy, SALib and the analytic values."""

from __future__ import annotations

import pickle
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np
import pytest
from scipy.special import ndtri
from scipy.stats import qmc

import armill
import uncertain

FORCES = np.array([[300.0, -200.0, 100.0], [-50.0, 80.0, 400.0]])


@pytest.fixture(scope="module")
def robot() -> armill.Robot:
    return uncertain.robot()


@pytest.fixture
def few(joints: np.ndarray) -> np.ndarray:
    return joints[:7]


def uniform(words: np.ndarray) -> np.ndarray:
    """The middle of one of 2^53 equal parts of the range from 0 to 1."""
    return ((words >> np.uint64(11)).astype(float) + 0.5) * 2.0**-53


def test_random_numbers_are_those_of_philox_in_numpy():
    found = armill.normal_draws(5, 9, "random", seed=17, first=100)
    for row, index in enumerate(range(100, 105)):
        words = np.random.Philox(key=[17, index]).random_raw(9)
        assert np.allclose(found[row], ndtri(uniform(words)), rtol=1e-14, atol=0)


def test_sobol_numbers_are_those_of_scipy_scrambled():
    count, inputs = 256, 200
    found = armill.normal_draws(count, inputs, "sobol", seed=3)
    points = (qmc.Sobol(inputs, scramble=False, bits=32).random(count) * 2.0**32).astype(np.uint64)
    for k in range(inputs):
        words = np.random.Philox(key=np.array([3, 2**64 - 1 - k], dtype=np.uint64)).random_raw(33)
        # Most significant bit first, of points and of the rows of a matrix with ones on its diagonal.
        bits = points[:, k, None] >> np.arange(31, -1, -1, dtype=np.uint64) & np.uint64(1)
        rows = words[1:, None] >> np.arange(31, -1, -1, dtype=np.uint64) & np.uint64(1)
        matrix = np.tril(rows.astype(int), -1) + np.eye(32, dtype=int)
        scrambled = (bits.astype(int) @ matrix.T % 2).astype(np.uint64) @ (np.uint64(1) << np.arange(63, 31, -1, dtype=np.uint64))
        assert np.allclose(found[:, k], ndtri(uniform(scrambled ^ words[0])), rtol=1e-12, atol=1e-15), k
    # Every part of the range has its share: 256 numbers, one in each of 256 parts.
    from scipy.special import ndtr

    assert all(np.array_equal(np.sort((ndtr(column) * count).astype(int)), np.arange(count)) for column in found.T)


def test_samples_depend_on_seed_and_index_alone(robot):
    whole = robot.sample(50, "random", seed=4)
    assert robot.sample(10, "random", seed=4, first=20) == whole[20:30] != whole[:10]
    assert robot.sample(50, "random", seed=5) != whole and len(whole[::-5]) == 10
    assert np.array_equal(whole[::-5].z, whole.z[::-5])
    assert robot.samples_at(whole.z) == whole and whole.robot == robot
    assert robot.sample(8).z.shape == (8, len(robot.uncertain_inputs))


def test_samples_are_values_plus_uncertainties(robot):
    count = 1 << 13
    samples = robot.sample(count, seed=1)
    names = [entry["name"] for entry in robot.uncertain_inputs]
    both = np.hstack([samples.compliances, samples.spring_compliances])
    expected = np.diag(np.append(robot.standard_uncertainty, 1e-7) ** 2)
    expected[:2, :2] = [[4e-14, 2e-14], [2e-14, 9e-14]]
    assert np.allclose(robot.compliance_covariance, expected, rtol=1e-12)
    # One independent input is one number: the rest of a Sobol sequence is far below its random counterpart.
    assert np.allclose(np.cov(both.T), expected, atol=0.02 * np.sqrt(np.outer(np.diag(expected), np.diag(expected))))
    assert np.allclose(both.mean(axis=0), robot.spring_compliance, atol=0.01 * np.sqrt(np.diag(expected)))
    u = np.radians(0.0006)
    backlash = np.radians(0.004) + u * samples.z[:, [names.index("backlash L"), names.index("backlash U")]]
    assert np.allclose(samples.backlash[:, 1:3], np.maximum(backlash, 0)) and not samples.backlash[:, [0, 3, 4, 5]].any()
    assert np.array_equal(samples.backlash_side[:, 1], np.sign(samples.z[:, names.index("backlash side L")]))
    assert not samples.backlash_side[:, [0, 2, 3, 4, 5]].any()
    motions = np.diag([1e-3, np.pi / 180, 1e-3])
    of_motions = motions @ [[0.01, 0.0002, 0], [0.0002, 0.0004, 0], [0, 0, 0.0025]] @ motions
    assert np.allclose(robot.geometry_covariance, of_motions, rtol=1e-9)
    size = np.sqrt(np.outer(np.diag(of_motions), np.diag(of_motions)))
    assert np.allclose(np.cov(samples.geometry.T), of_motions, atol=0.02 * size)
    assert np.allclose(samples.model_error, 0.04 * samples.z[:, names.index("model error")])
    # RP of ISO 9283 is 3.616 standard deviations.
    assert np.allclose(samples.scatter, 0.06e-3 / 3.616087956534285 * samples.z[:, -3:])
    assert samples.masses.shape == (count, 7) and (samples.masses >= 0).all()
    assert np.array_equal(samples.cut > 0, (samples.masses == 0).any(axis=1) | (both == 0).any(axis=1))


def test_the_deviation_of_samples_is_that_of_numpy(robot, few, tool):
    samples = robot.sample(20, seed=2)
    found = robot.deviation(few, FORCES, tool, samples=samples)
    assert found.shape == (20, 7, 2, 3)
    screws = robot.spring_jacobian(few, tool)
    torques = np.einsum("nik,ci->nck", screws[:, :3], FORCES)
    springs = np.hstack([samples.compliances, samples.spring_compliances])
    expected = np.einsum("nik,sk,nck->snci", screws[:, :3], springs, torques)
    expected *= (1 + samples.model_error)[:, None, None, None]
    assert np.allclose(found, expected, rtol=1e-12, atol=1e-18)
    for threads in (1, 3):
        assert np.array_equal(robot.deviation(few, FORCES, tool, samples=samples, threads=threads), found)
    paired = robot.deviation(few[:2], FORCES, tool, samples=samples, paired=True)
    assert np.array_equal(paired, found[:, [0, 1], [0, 1]])
    compliance = robot.compliance(few, tool, samples=samples)
    assert np.allclose(compliance, np.einsum("nik,sk,njk->snij", screws, springs, screws), rtol=1e-12, atol=1e-20)
    contributions = robot.contributions(few, FORCES, tool, samples=samples)
    assert np.allclose(contributions.sum(axis=3), found, rtol=1e-12, atol=1e-18)
    out = np.empty_like(found)
    assert robot.deviation(few, FORCES, tool, samples=samples, out=out) is out and np.array_equal(out, found)


def test_all_sources_are_load_geometry_backlash_and_scatter(robot, few, tool):
    samples = robot.sample(20, seed=2)
    found = robot.deviation(few, FORCES, tool, samples=samples, all_sources=True)
    rest = found - robot.deviation(few, FORCES, tool, samples=samples) - samples.scatter[:, None, None, :]
    jacobian = robot.spring_jacobian(few, tool)[:, :3]
    # L rests on the side of the sample, U on that of the torque of the load.
    torques = np.einsum("nik,ci->nck", robot.spring_jacobian(few, tool)[:, :3], FORCES)
    sides = np.broadcast_to(samples.backlash_side[:, None, None, 1], (20, 7, 2))
    by_l = np.einsum("ni,snc->snci", jacobian[:, :, 1], 0.5 * sides * samples.backlash[:, None, None, 1])
    side_u = np.sign(torques[..., 2])
    by_u = np.einsum("ni,snc->snci", jacobian[:, :, 2], 0.5 * side_u * samples.backlash[:, 2, None, None])
    rest -= by_l + by_u
    # What is left is of the geometry: the same for every load, zero on average.
    assert np.allclose(rest, rest[:, :, :1], atol=1e-12) and np.abs(rest).max() > 1e-5
    # L about y: the tool turns about the origin of its frame; of the arm, the axis of L is along y of base turned by S.
    nothing = robot.deviation(few, FORCES, tool, all_sources=True)
    assert np.allclose(nothing - robot.deviation(few, FORCES, tool), np.einsum("ni,nc->nci", jacobian[:, :, 2], 0.5 * side_u * np.radians(0.004)))


def test_the_covariance_is_that_of_samples(robot, few, tool):
    # Of many samples, without the side of the backlash, which the law of propagation does not have.
    samples = robot.sample(1 << 13, seed=6)
    z = samples.z.copy()
    side = [entry["source"] for entry in robot.uncertain_inputs].index("backlash side")
    z[:, side] = 1.0
    for all_sources in (False, True):
        found = robot.deviation(few, FORCES, tool, samples=robot.samples_at(z), all_sources=all_sources)
        expected = robot.deviation_covariance(few, FORCES, tool, all_sources=all_sources)
        assert expected.shape == (7, 2, 3, 3) and np.allclose(expected, np.swapaxes(expected, -1, -2))
        off = found - found.mean(axis=0)
        spread = np.einsum("snci,sncj->ncij", off, off) / len(z)
        size = np.trace(expected, axis1=-2, axis2=-1)[..., None, None]
        assert (np.abs(spread - expected) < 0.02 * size).all()
    paired = robot.deviation_covariance(few[:2], FORCES, tool, paired=True)
    assert np.array_equal(paired, robot.deviation_covariance(few[:2], FORCES, tool)[[0, 1], [0, 1]])


def test_evaluation_of_samples_is_that_of_robots_with_them(mh12, joints, tool):
    soft = mh12.with_compliance(mh12.joint_compliance, 0.1 * mh12.joint_compliance)
    samples, poses = soft.sample(6, "random", seed=9), mh12.forward(joints[:40], tool)
    found = soft.evaluate(poses, FORCES, tool, branch="best", normal=[0, 0, 1], samples=samples)
    assert found.deviation.shape == (6, 40, 2, 3)
    for i, compliances in enumerate(samples.compliances):
        one = mh12.with_compliance(compliances).evaluate(poses, FORCES, tool, branch="best", normal=[0, 0, 1])
        assert np.array_equal(found.deviation[i], one.deviation, equal_nan=True) and np.array_equal(found.joints[i], one.joints, equal_nan=True)


def test_modes_and_gravity_of_samples(mh12, few):
    samples = mh12.sample(4, seed=3)
    modes = mh12.modes(few, samples=samples)
    assert modes.shape == (4, 7, 6, 8)
    gravity = mh12.gravity(few, np.zeros(6), samples=samples)
    assert gravity.shape == (4, 7, 3)
    nominal = mh12.samples_at(np.zeros((1, samples.z.shape[1])))
    assert np.array_equal(mh12.modes(few, samples=nominal)[0], mh12.modes(few))
    assert np.array_equal(mh12.gravity(few, np.zeros(6), samples=nominal)[0], mh12.gravity(few, np.zeros(6)))
    # A mass 50 % above its value sags more in proportion, if it alone is there to sag.
    assert not np.array_equal(gravity[0], gravity[1])


def test_covariances_go_in_and_out(mh12, few):
    c = mh12.joint_compliance
    root = np.random.default_rng(8).normal(size=(6, 6)) * 0.1 * c[:, None]
    covariance = root @ root.T
    given = mh12.with_compliance(c, covariance, source="a test")
    assert np.allclose(given.compliance_covariance, covariance, rtol=1e-15)
    assert np.allclose(given.standard_uncertainty, np.sqrt(np.diag(covariance)))
    screws = mh12.spring_jacobian(few)[:, :3]
    per_unit = screws * np.einsum("nik,i->nk", screws, FORCES[0])[:, None]
    expected = np.einsum("nik,kl,njl->nij", per_unit, covariance, per_unit)
    assert np.allclose(given.deviation_covariance(few, FORCES[0]), expected, rtol=1e-9, atol=1e-24)
    again = armill.Robot.from_text(given.to_toml(), "armill")
    assert np.allclose(again.compliance_covariance, covariance, rtol=1e-5, atol=1e-7 * covariance.max())
    assert "a test" in given.to_toml()
    copy = pickle.loads(pickle.dumps(given))
    assert copy == given != mh12.with_compliance(c) and np.array_equal(copy.compliance_covariance, given.compliance_covariance)
    assert mh12.with_compliance(c).standard_uncertainty.tolist() == [0.0] * 6
    assert armill.Robot.load("universal-robots/ur10").standard_uncertainty is None
    for wrong, words in [
        (-covariance, "variance .* is negative"),
        (np.eye(5), r"expected shape \(6,\) or \(6, 6\), given \(5, 5\)"),
        (covariance + np.triu(np.full((6, 6), 1e-12), 1), "symmetric"),
        (-0.1 * c, "is not a number from 0 to"),
    ]:
        with pytest.raises(armill.InputError, match=words):
            mh12.with_compliance(c, wrong)


def test_the_spring_jacobian_gives_the_compliance_of_a_coupled_arm(joints):
    fanuc = armill.Robot.load("fanuc/r2000ic")
    low, high = fanuc.limits.T
    q = low + np.random.default_rng(2).uniform(0.2, 0.8, (20, 6)) * (high - low)
    springs = fanuc.spring_jacobian(q)
    expected = fanuc.compliance(q)
    assert np.allclose(springs @ np.diag(fanuc.spring_compliance) @ springs.transpose(0, 2, 1), expected, rtol=1e-12, atol=1e-22)
    of_controller = fanuc.jacobian(q)
    wrong = of_controller @ np.diag(fanuc.joint_compliance) @ of_controller.transpose(0, 2, 1)
    assert np.abs(wrong / expected - 1).max() > 0.05
    mh12 = armill.Robot.load("yaskawa/mh12")
    assert np.allclose(np.abs(mh12.spring_jacobian(joints)), np.abs(mh12.jacobian(joints)), atol=1e-14)
    assert mh12.spring_names == mh12.joint_names and uncertain.robot().spring_names[6:] == ["U spring 1"]


def test_shares_are_those_of_the_variances_where_results_are_linear(mh12, few, tool):
    c = mh12.joint_compliance
    u = np.array([0.1, 0.2, 0.05, 0.1, 0.15, 0.3]) * c
    given = mh12.with_compliance(c, u)
    screws = given.spring_jacobian(few, tool)[:, :3]
    torques = np.einsum("nik,ci->nck", screws, FORCES)
    variances = (np.einsum("nik,nck->knci", screws, torques) * u[:, None, None, None]) ** 2
    expected = variances / variances.sum(axis=0)
    shares = armill.variance_shares(given, few, FORCES, tool, all_sources=False)
    # Masses have no effect without gravity.
    assert shares.groups[:6] == given.joint_names
    assert np.allclose(shares.first_order[:6], expected, atol=1e-9) and np.allclose(shares.first_order[6:], 0)
    assert np.allclose(shares.variance, variances.sum(axis=0), rtol=1e-9)
    covariance = given.deviation_covariance(few, FORCES, tool)
    assert np.allclose(shares.variance, np.diagonal(covariance, axis1=-2, axis2=-1), rtol=1e-9)
    assert np.allclose(shares.mean, given.deviation(few, FORCES, tool), rtol=1e-12)
    sobol = armill.sobol_indices(given, few, FORCES, tool, all_sources=False, n=4096, seed=1)
    assert sobol.groups == shares.groups and sobol.first_order.shape == (len(sobol.groups), 7, 2, 3)
    assert np.abs(sobol.first_order - shares.first_order).max() < 0.02
    assert np.abs(sobol.total - shares.total).max() < 0.02
    assert (np.abs(sobol.total - shares.total) < 5 * sobol.total_u + 1e-9).all()
    assert np.allclose(sobol.variance, shares.variance, rtol=0.05) and sobol.evaluations == 4096 * (2 + len(sobol.groups))


def test_indices_are_those_of_salib(robot, few, tool):
    sobol = pytest.importorskip("SALib.analyze.sobol")
    n, inputs = 512, len(robot.uncertain_inputs)
    found = armill.sobol_indices(robot, few[0], FORCES[0], tool, n=n, by="input", seed=12)
    assert found.groups == [entry["name"] for entry in robot.uncertain_inputs]
    z = armill.normal_draws(n, 2 * inputs, seed=12)

    def run(z):
        return robot.deviation(few[0], FORCES[0], tool, samples=robot.samples_at(z), all_sources=True)[:, 2]

    first, second = z[:, :inputs], z[:, inputs:]
    a, b = run(first), run(second)
    rows = np.empty((n, inputs + 2))
    rows[:, 0], rows[:, -1] = a, b
    centre = np.concatenate([a, b]).mean()
    for k in range(inputs):
        mixed = first.copy()
        mixed[:, k] = second[:, k]
        rows[:, k + 1] = run(mixed)
        ours = found.first_order[k, 2], found.total[k, 2]
        theirs = [estimate(a - centre, rows[:, k + 1] - centre, b - centre) for estimate in (sobol.first_order, sobol.total_order)]
        assert np.allclose(ours, np.ravel(theirs), rtol=1e-9, atol=1e-12), k
    problem = {"num_vars": inputs, "names": found.groups, "bounds": [[0, 1]] * inputs}
    whole = sobol.analyze(problem, rows.ravel(), calc_second_order=False, seed=1)
    assert np.abs(whole["S1"] - found.first_order[:, 2]).max() < 0.02
    assert np.abs(whole["ST"] - found.total[:, 2]).max() < 0.02


def test_interactions_are_in_the_total_alone(robot):
    def product(samples):
        return samples.z[:, 0] + 2 * samples.z[:, 1] * samples.z[:, 2] + 0 * samples.z[:, 3]

    found = armill.sobol_indices(robot, function=product, by="input", n=1 << 14)
    # A product of two inputs is where a Sobol sequence is no better than random numbers: within four standard errors.
    for values, u, expected in [
        (found.first_order, found.first_order_u, [0.2, 0, 0, 0]),
        (found.total, found.total_u, [0.2, 0.8, 0.8, 0]),
    ]:
        assert (np.abs(values[:4] - expected) <= 4 * u[:4]).all() and (u[:4] < 0.02).all(), (values[:4], u[:4])
    assert found.variance == pytest.approx(5, rel=0.02) and found.mean.shape == ()
    linear = armill.variance_shares(robot, function=lambda samples: samples.z[:, :2] @ [[3.0], [4.0]], by="input")
    assert np.allclose(linear.first_order[:2, 0], [9 / 25, 16 / 25]) and np.allclose(linear.variance, 25)


def test_inputs_are_grouped_by_source_and_by_what_they_change(robot, few):
    sources = armill.variance_shares(robot, few, FORCES, by="source")
    assert sources.groups == ["compliance", "backlash", "backlash side", "mass", "geometry", "model error", "repeatability"]
    assert np.allclose(sources.first_order.sum(axis=0), 1)
    contributors = armill.variance_shares(robot, few, FORCES)
    # The compliances of S and L are correlated.
    assert contributors.groups == ["S+L", "U", "R", "B", "T", "base", "geometry", "model error", "repeatability"]
    assert np.allclose(contributors.first_order[-3], sources.first_order[4])
    each = armill.variance_shares(robot, few, FORCES, by="input")
    assert np.allclose(each.first_order.sum(axis=0), 1) and len(each.groups) == len(robot.uncertain_inputs)
    assert sources == pickle.loads(pickle.dumps(sources)) and sources != contributors
    assert "<th>geometry</th>" in sources._repr_html_()
    frame = sources.to_pandas()
    assert frame.loc[("geometry", 3, 1, 2), "total"] == sources.total[4, 3, 1, 2]
    data = sources.to_xarray()
    assert float(data.first_order.sel(group="mass").max()) == sources.first_order[3].max()


def test_what_cannot_be_sampled_is_refused(robot, mh12, few):
    exact = armill.Robot.from_opw(a1=0.1, a2=-0.1, b=0.0, c1=0.4, c2=0.6, c3=0.6, c4=0.1)
    with pytest.raises(armill.InputError, match="no joint compliance"):
        exact.sample(3)
    with pytest.raises(armill.InputError, match="has no uncertainties"):
        exact.with_compliance(np.full(6, 1e-6)).sample(3)
    with pytest.raises(armill.InputError, match="`latin` is not a valid method"):
        robot.sample(3, "latin")
    with pytest.raises(armill.InputError, match="more than a sequence has"):
        robot.sample(3, first=2**32 - 2)
    with pytest.raises(armill.InputError, match="at most 256 inputs"):
        armill.normal_draws(3, 257)
    assert armill.normal_draws(3, 257, "random").shape == (3, 257) and armill.normal_draws(0, 5).shape == (0, 5)
    with pytest.raises(armill.InputError, match=r"z: expected shape \(n, 24\), for compliance S\+L 1, .*, given \(3, 5\)"):
        robot.samples_at(np.zeros((3, 5)))
    with pytest.raises(armill.InputError, match="the samples are of robot `uncertain`"):
        mh12.deviation(few, FORCES, samples=robot.sample(2))
    with pytest.raises(armill.InputError, match="compliances and samples are given"):
        robot.deviation(few, FORCES, samples=robot.sample(2), compliances=mh12.joint_compliance)
    with pytest.raises(armill.InputError, match="given twice or not at all"):
        armill.sobol_indices(robot)
    with pytest.raises(armill.InputError, match="`source`, `contributor` or `input`"):
        armill.sobol_indices(robot, few, FORCES, by="joint")
    with pytest.raises(armill.InputError, match=r"a result of shape \(\) for 64 samples"):
        armill.sobol_indices(robot, function=lambda samples: 1.0, n=64)
    with pytest.raises(armill.InputError, match="n is 1"):
        armill.sobol_indices(robot, few, FORCES, n=1)


def deviation_of(samples: armill.Samples) -> np.ndarray:
    return samples.robot.deviation(np.full(6, 0.3), FORCES, samples=samples, threads=1)


def test_samples_travel_to_other_processes(robot):
    samples = robot.sample(40, seed=7)
    whole = deviation_of(samples)
    assert pickle.loads(pickle.dumps(samples)) == samples
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        parts = list(pool.map(deviation_of, [samples[:20], samples[20:]]))
    assert np.array_equal(np.concatenate(parts), whole)
    joblib = pytest.importorskip("joblib")
    parts = joblib.Parallel(n_jobs=2)(joblib.delayed(deviation_of)(samples[i : i + 10]) for i in range(0, 40, 10))
    assert np.array_equal(np.concatenate(parts), whole)
