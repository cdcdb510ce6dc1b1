"""The discrete equilibrium of a sheet: derivatives, invariances, inertia, effects."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mpi4py import MPI
from petsc4py import PETSc

from dolfinx import fem
from dolfinx.fem import petsc

from pantograph_fem import dolfinx_api as api
from pantograph_fem.case import case_from_dict
from pantograph_fem.continuum.equilibrium import ContinuumEquilibrium
from pantograph_fem.physics.rigid_motion import QUARTER_TURN, RigidMotion
from pantograph_fem.sheet.build import build_domain, build_grips, discretise_sheet
from pantograph_fem.sheet.grip import GripSupport

from .conftest import COARSE, merged
from .distributed import dot, largest, norm, own_blocks, rough

pytestmark = pytest.mark.core


def build(**changes):
    case = case_from_dict(merged(COARSE, changes))
    domain = build_domain(case, MPI.COMM_WORLD)
    discretisation = discretise_sheet(case, domain)
    supports = [GripSupport(grip, discretisation) for grip in build_grips(case, domain)]
    return ContinuumEquilibrium(discretisation, supports)


SCHEMES = ("micromorphic", "hinge")
CLAMPS = {"bottom": {"hold": "clamp"}, "top": {"hold": "clamp", "rotation": 30.0}}


@pytest.fixture(scope="module", params=SCHEMES)
def sheet(request):
    """Between grips that clamp, so that the weakly held directions count, too."""
    return build(
        discretisation={"scheme": request.param},
        grips=CLAMPS if request.param == "hinge" else {},
    )


def random_state(equilibrium, seed, size=0.05):
    """A state with stretches, shear and curvatures of a few per cent in typical sizes."""
    x = equilibrium.typical_sizes.copy()
    for number, field in enumerate(equilibrium.discretisation.fields):
        dofs, places = own_blocks(equilibrium, field.name)
        if field.name == "displacement":
            x[dofs] = 0.005  # of the mesh size, or elements turn inside out
        x[dofs] *= size * rough(places, dofs.shape[1], [seed, number], wavelength=0.01)
    return x


def moved(equilibrium, x, motion):
    """The state after a superposed rigid motion: χ → Rχ + c, F → RF, Λ → RΛ."""
    y = x.copy()
    R = motion.rotation(1.0)
    dofs, X = own_blocks(equilibrium, "displacement")
    current = X + x[dofs]
    y[dofs] = current + motion.displacement(current, 1.0) - X
    for name, reference in (("gradient", np.eye(2)), ("multiplier", np.zeros((2, 2)))):
        if equilibrium.discretisation.field(name) is None:
            continue
        dofs, _ = own_blocks(equilibrium, name)
        F = reference + x[dofs].reshape(-1, 2, 2)
        y[dofs] = (R @ F - reference).reshape(-1, 4)
    return y


def potential(equilibrium, x):
    equilibrium.load_state(x, 0.0)
    functional = equilibrium.discretisation.functional
    for support in equilibrium.supports:
        functional += sum(support.stored.values())
    return MPI.COMM_WORLD.allreduce(fem.assemble_scalar(api.form(functional)))


def free_residual(equilibrium, x):
    r = equilibrium.matrix().createVecLeft()
    equilibrium.residual(x, 0.0, r)
    return r.array.copy()


motions = st.builds(
    RigidMotion,
    translation=st.tuples(st.floats(-1, 1), st.floats(-1, 1)),
    angle=st.floats(-3.1, 3.1),
    pivot=st.just((0.01, 0.02)),
)


@pytest.fixture(scope="module", params=SCHEMES)
def free_sheet(request):
    return build(discretisation={"scheme": request.param})


@given(motions)
@settings(max_examples=20, deadline=None)
def test_a_rigid_motion_stores_and_resists_nothing(free_sheet, motion):
    sheet = free_sheet
    x = moved(sheet, sheet.undeformed(), motion)
    assert sum(sheet.energies(x, 0.0).values()) < 1e-12
    assert largest(free_residual(sheet, x)) < 1e-9


@given(motions, st.integers(0, 2**32 - 1))
@settings(max_examples=20, deadline=None)
def test_potential_is_frame_indifferent(free_sheet, motion, seed):
    sheet = free_sheet
    x = random_state(sheet, seed)
    y = moved(sheet, x, motion)
    assert potential(sheet, y) == pytest.approx(potential(sheet, x), rel=1e-9, abs=1e-9)
    for effect, energy in sheet.energies(x, 0.0).items():
        assert sheet.energies(y, 0.0)[effect] == pytest.approx(energy, rel=1e-9)


def taylor_rate(remainder):
    """Order of a Taylor remainder as the step is halved."""
    coarse, fine = remainder(1e-5), remainder(5e-6)
    return np.log2(coarse / fine)


@pytest.mark.parametrize(("sabotage", "rate"), [(1.0, 2.0), (1.01, 1.0)])
def test_residual_is_the_derivative_of_the_potential(sheet, sabotage, rate):
    """Off by 1 %, the remainder would be of first order: the test can tell."""
    x, v = random_state(sheet, 1), random_state(sheet, 2)
    v[sheet._owned_dofs] = 0.0
    slope = sabotage * dot(free_residual(sheet, x), v)

    def remainder(h):
        return abs(potential(sheet, x + h * v) - potential(sheet, x) - h * slope)

    assert taylor_rate(remainder) == pytest.approx(rate, abs=0.1)


@pytest.mark.parametrize(("sabotage", "rate"), [(1.0, 2.0), (1.01, 1.0)])
def test_tangent_is_the_derivative_of_the_residual(sheet, sabotage, rate):
    x, v = random_state(sheet, 3), random_state(sheet, 4)
    v[sheet._owned_dofs] = 0.0
    A = sheet.matrix()
    sheet.tangent(x, 0.0, A)
    direction, product = A.createVecLeft(), A.createVecLeft()
    direction.array[:] = v
    A.mult(direction, product)
    slope = sabotage * product.array
    start = free_residual(sheet, x)

    def remainder(h):
        return norm(free_residual(sheet, x + h * v) - start - h * slope)

    assert taylor_rate(remainder) == pytest.approx(rate, abs=0.1)


def full_tangent(sheet, x):
    """The tangent as it is assembled, both halves of it."""
    sheet.load_state(x, 0.0)
    A = petsc.assemble_matrix(sheet._forms.tangent, bcs=sheet._bcs)
    A.assemble()
    return A


def test_tangent_is_symmetric(free_sheet):
    x = random_state(free_sheet, 5)
    free_sheet.tangent(x, 0.0, free_sheet.matrix())  # where stresses are extrapolated from
    A = full_tangent(free_sheet, x)
    difference = A.copy()
    difference.axpy(-1.0, A.copy().transpose())
    assert difference.norm() < 1e-12 * A.norm()


def test_half_of_the_tangent_acts_as_the_whole(sheet):
    """Whichever process has a row, and with a place for every entry, but no more."""
    x = random_state(sheet, 5)
    half = sheet.matrix()
    sheet.tangent(x, 0.0, half)
    full = full_tangent(sheet, x)
    (v, one), other = half.createVecs(), half.createVecLeft()
    v.array[:] = random_state(sheet, 6)
    half.mult(v, one)
    full.mult(v, other)
    assert norm(one.array - other.array) < 1e-13 * norm(other.array)
    info = half.getInfo(PETSc.Mat.InfoType.GLOBAL_SUM)
    assert info["mallocs"] == 0
    assert info["nz_allocated"] == info["nz_used"]
    block = half.getBlockSize()
    places = full.getInfo(PETSc.Mat.InfoType.GLOBAL_SUM)["nz_used"]
    assert info["nz_used"] == (places + block * half.size[0]) / 2


@pytest.mark.parametrize("hold", ["position", "clamp"])
@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("sabotage", [1.0, 1.01])
def test_load_rate_is_the_tangent_of_the_path(coarse_path, sabotage, scheme, hold):
    simulation, steps = coarse_path(
        stops=(0.499, 0.5, 0.501, 1.0),
        grips={"top": {"hold": hold, "translation": [0.01, 0.02], "rotation": 20.0}},
        discretisation={"scheme": scheme, "degree": 2},
    )
    before, here, after = (s for s in steps if s.load in (0.499, 0.5, 0.501))
    sizes = simulation.equilibrium.typical_sizes
    difference = (after.x - before.x) / 0.002 / sizes
    rate = sabotage * here.linearisation.rate / sizes
    error = largest(difference - rate) / largest(rate)
    assert (error < 1e-4) == (sabotage == 1.0)


@pytest.mark.parametrize("hold", ["position", "clamp"])
@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_shift_of_what_is_held_is_followed_along_the_tangent(coarse_path, scheme, hold):
    """Held unknowns that are shifted change the other forces by minus what is lifted."""
    simulation, steps = coarse_path(
        grips={"top": {"hold": hold}},
        discretisation={"scheme": scheme, "degree": 2},
        material={"shear_exponent": 2.0},  # without a kink
    )
    equilibrium, x = simulation.equilibrium, steps[-1].x
    equilibrium.tangent(x, 1.0, equilibrium.matrix())  # of which it is a part
    dofs, places = own_blocks(equilibrium, "displacement")
    shift, h = np.zeros_like(x), 1e-5
    shift[dofs] = 1e-3 * rough(places, 2, seed=5, wavelength=0.05)
    held = np.isin(np.arange(len(x)), equilibrium.held_dofs)
    moved = np.where(held, shift, 0.0)
    forces = equilibrium.matrix().createVecs()
    for r, sign in zip(forces, (1, -1), strict=True):
        equilibrium.residual(x + sign * h * moved, 1.0, r)
    change = (forces[0].array - forces[1].array) / (2 * h)
    lifted = equilibrium.lift(x, 1.0, shift)
    error = largest(lifted - np.where(held, shift, -change))
    assert error < 1e-5 * largest(np.where(held, 0.0, lifted))


@pytest.mark.parametrize("hold", ["position", "clamp"])
@pytest.mark.parametrize("scheme", SCHEMES)
def test_work_of_the_grip_is_the_stored_energy(coarse_path, scheme, hold):
    """dE/dt = f · d + m θ for a grip that is moved and turned about a point of its own."""
    angle, d = 25.0, np.array([0.01, 0.02])
    pivot = np.array([0.05, 0.25])
    simulation, steps = coarse_path(
        stops=(0.698, 0.699, 0.7, 0.701, 0.702, 1.0),
        grips={
            "top": {
                "hold": hold,
                "translation": d.tolist(),
                "rotation": angle,
                "pivot": pivot.tolist(),
            }
        },
        discretisation={"scheme": scheme, "degree": 2},
    )
    near = {round(s.load, 6): s for s in steps}
    equilibrium = simulation.equilibrium
    E = [sum(equilibrium.energies(near[t].x, t).values()) for t in (0.698, 0.699, 0.701, 0.702)]
    power = (E[0] - 8 * E[1] + 8 * E[2] - E[3]) / 0.012
    reaction = equilibrium.reactions(near[0.7].x, 0.7)[1]
    theta = np.radians(angle)
    motion = RigidMotion(tuple(d), theta, tuple(pivot))
    centre = np.array([[0.034, 0.204]])
    velocity = motion.displacement_rate(centre, 0.7)[0]
    assert np.dot(reaction.force, velocity) + reaction.moment * theta == pytest.approx(
        power, rel=1e-6
    )


@pytest.mark.parametrize("hold", ["position", "clamp"])
@pytest.mark.parametrize("scheme", SCHEMES)
def test_reactions_of_the_two_grips_balance(coarse_path, scheme, hold):
    top = {"hold": hold, "translation": [0.01, 0.02], "rotation": 15.0}
    simulation, steps = coarse_path(
        grips={"bottom": {"hold": hold}, "top": top}, discretisation={"scheme": scheme, "degree": 2}
    )
    bottom, top = simulation.equilibrium.reactions(steps[-1].x, 1.0)
    f0, f1 = np.array(bottom.force), np.array(top.force)
    np.testing.assert_allclose(f0 + f1, 0.0, atol=1e-6 * np.abs(f1).max())
    arm = np.array([0.01, 0.224])
    torque = top.moment + bottom.moment + arm @ (-QUARTER_TURN @ f1)
    assert torque == pytest.approx(0.0, abs=1e-6 * abs(top.moment))


def dense(A):
    """All entries on every process, column by column."""
    unit, column = A.createVecs()
    first, last = unit.getOwnershipRange()
    columns = []
    for i in range(A.size[0]):
        unit.set(0.0)
        if first <= i < last:
            unit.array[i - first] = 1.0
        A.mult(unit, column)
        columns.append(np.concatenate(MPI.COMM_WORLD.allgather(column.array.copy())))
    return np.array(columns)


def test_inertia_is_that_of_the_dense_tangent(coarse_path):
    simulation, steps = coarse_path(mesh={"size": 0.034, "corner_size": 0.034})
    equilibrium = simulation.equilibrium
    A = equilibrium.matrix()
    last = steps[-1]
    equilibrium.tangent(last.x, last.load, A)
    scale = np.concatenate(MPI.COMM_WORLD.allgather(equilibrium.typical_sizes))
    eigenvalues = np.linalg.eigvalsh(dense(A) * np.outer(scale, scale))
    assert last.linearisation.negative_pivots == (eigenvalues < 0).sum()
    assert last.linearisation.stable
    assert last.linearisation.expected_negative_pivots == simulation.dofs["multiplier"]


@pytest.mark.parametrize(
    ("degree", "mesh"),
    [
        *((degree, {"corner_size": 0.034 / 500}) for degree in (2, 3, 4)),
        *((degree, {"corner_size": 0.034 / 50, "growth": 1.0}) for degree in (5, 6)),
    ],
)
def test_a_stable_state_is_a_minimum_in_the_hinge_scheme(coarse_path, degree, mesh):
    """On bad meshes, too: every eigenvalue is positive, without a penalty to tune."""
    simulation, steps = coarse_path(
        discretisation={"scheme": "hinge", "degree": degree},
        mesh={"size": 0.034, "grip_size": 0.01, **mesh},
        grips={"top": {"hold": "clamp", "translation": [0.0, 0.05]}},
        stops=(0.5, 1.0),
    )
    assert simulation.dofs.keys() == {"displacement"}
    for step in steps:
        assert step.linearisation.expected_negative_pivots == 0
        assert step.linearisation.stable


def test_only_effects_with_a_stiffness_make_fields():
    full = build().discretisation
    assert [field.name for field in full.fields] == ["displacement", "gradient", "multiplier"]
    assert set(full.densities) == {"stretch", "shear", "bending"}
    assert full.field("gradient").size == full.field("multiplier").size

    for bending in (None, 0.0):
        plain = build(material={"bending": bending}).discretisation
        assert [field.name for field in plain.fields] == ["displacement"]
        assert plain.field("displacement").size == full.field("displacement").size
        assert plain.multiplier_dofs == 0
        assert plain.curvatures == ()
        assert set(plain.densities) == {"stretch", "shear"}

    no_shear = build(material={"shear": None, "shear_exponent": None}).discretisation
    assert set(no_shear.densities) == {"stretch", "bending"}


def test_an_absent_effect_leaves_no_coefficient_in_the_form():
    def constants(**material):
        return len(build(material=material).discretisation.functional.constants())

    # cos and sin of the fibre angle; K_e and K_b of two families; K_p, γ, δ
    assert constants() == 2 + 2 + 2 + 3
    assert constants(shear_exponent=2.0) == 2 + 2 + 2 + 1
    assert constants(shear=None, shear_exponent=None) == 2 + 2 + 2
    assert constants(bending=None) == 2 + 2 + 3
    assert constants(stretch=[1e5, 0.0]) == 2 + 1 + 2 + 3


def test_degrees_are_selectable():
    for degree, auxiliary in ((2, 1), (3, 1), (3, 2), (4, 3), (6, 5)):
        d = build(discretisation={"degree": degree, "auxiliary_degree": auxiliary}).discretisation
        for name, k in (("displacement", degree), ("gradient", auxiliary)):
            nodes = api.cell_dofs(d.field(name).space).shape[1]
            assert nodes == (k + 1) * (k + 2) // 2  # of a triangle of degree k
        assert d.field("multiplier").space.ufl_element() == d.field("gradient").space.ufl_element()
