# %% [markdown]
# # How far does a hanging flag stretch?
#
# A flag of soft cloth hangs from its upper edge. Its own weight pulls it longer, most where it hangs and not at all at
# its lower hem. For a sheet without lateral contraction this has a closed form, so we can see how exact the simulation
# is. The page is made from [flag.py](flag.py) by `tools/tutorial`; a test runs it and compares every number.

# %%
import muslin
import numpy as np

HEIGHT, WIDTH = 1.0, 0.6  # of the flag [m]
DENSITY = 0.2  # areal density [kg/m²]
STIFFNESS = 20.0  # membrane stiffness: force per width and strain [N/m]
GRAVITY = 9.81  # [m/s²]

# %% [markdown]
# ## A flag made of arrays
#
# The mesh is a grid of quads in the plane z = 0. Its group `hem` is the upper edge, by which it will hang.


# %%
def flag_mesh(rows: int) -> muslin.Mesh:
    columns = max(2, round(rows * WIDTH / HEIGHT))
    x, y = np.meshgrid(np.linspace(0, WIDTH, columns + 1), np.linspace(0, HEIGHT, rows + 1))
    positions = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    corner = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    quads = np.stack([corner, corner + 1, corner + columns + 2, corner + columns + 1], axis=1)
    return muslin.Mesh(positions, quads, groups={"hem": np.flatnonzero(positions[:, 1] == HEIGHT)}, name="flag")


print(flag_mesh(20))

# %% [markdown]
# ## The scene
#
# The words are those of a scene file. A lateral contraction (`poisson`) of 0 makes every vertical strip hang for
# itself. Warp runs up and down. Damping lets the flag come to rest.


# %%
def hang(rows: int) -> muslin.Simulation:
    material = {
        "areal_density": DENSITY,
        "membrane_warp": STIFFNESS,
        "poisson": 0.0,
        "bending_warp": 1e-5,
        "mass_damping": 4.0,
    }
    scene = muslin.make_scene(
        title="a hanging flag",
        time={"duration": 10, "frame_rate": 10, "steps_per_frame": 2},
        solver={"tolerance": 1e-6},
        body=[{"mesh": flag_mesh(rows), "model": "shell", "warp": [0, 1, 0], "material": material}],
        pin=[{"where": {"group": "hem"}}],
        force=[{"type": "gravity", "acceleration": [0, -GRAVITY, 0]}],
    )
    simulation = muslin.Simulation(scene)
    for _ in simulation:
        pass
    return simulation


simulation = hang(20)
history = simulation.history()
print(f"speed after {simulation.time:g} s: {np.abs(simulation.velocities).max():.0e} m/s")
print(f"largest stretch: {simulation.diagnostics.max_stretch:.4f}")

# %% [markdown]
# ## What must come out
#
# Let s be the height of a point of the flag at rest. Below it hangs the weight DENSITY · GRAVITY · s per width. The
# membrane is St. Venant–Kirchhoff: a stretch λ has the Green strain (λ² − 1)/2, and per width of rest it pulls with
# STIFFNESS · λ (λ² − 1)/2. Where both are equal, the flag is at rest:
#
# λ (λ² − 1)/2 = DENSITY · GRAVITY · s / STIFFNESS
#
# The cubic has one root λ ≥ 1. A point hangs at its height in the stretched flag, HEIGHT − ∫ λ ds from s to the hem.


# %%
def stretch(s: np.ndarray) -> np.ndarray:
    pull = DENSITY * GRAVITY * s / STIFFNESS
    stretch = 1 + pull
    for _ in range(20):  # Newton's iteration on the cubic
        stretch = stretch - (stretch**3 / 2 - stretch / 2 - pull) / (1.5 * stretch**2 - 0.5)
    return stretch


def height(s: np.ndarray) -> np.ndarray:
    nodes, weights = np.polynomial.legendre.leggauss(8)
    length = HEIGHT - s
    at = s[:, None] + length[:, None] * (nodes + 1) / 2
    return HEIGHT - length / 2 * (stretch(at) * weights).sum(axis=1)


print(f"at the hem λ = {stretch(np.array([HEIGHT]))[0]:.4f}; the flag is {-height(np.zeros(1))[0] * 1000:.2f} mm longer")

# %% [markdown]
# ## What did come out
#
# Each row of quads has one stretch: the distance of its edges over that at rest.


# %%
def measured(simulation: muslin.Simulation) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Heights at rest of the rows of vertices, their heights now, and the stretch of the rows of quads between."""
    rest, now = simulation.model.rest_positions[:, 1], simulation.positions[:, 1]
    heights = np.unique(rest)
    hanging = np.array([now[rest == s].mean() for s in heights])
    return heights, hanging, np.diff(hanging) / np.diff(heights)


rest, hanging, stretches = measured(simulation)
middles = (rest[1:] + rest[:-1]) / 2
print("height at rest   stretch   closed form")
for s, found, exact in list(zip(middles, stretches, stretch(middles)))[::4]:
    print(f"{s:10.3f} m   {found:9.5f}   {exact:9.5f}")
print(f"the lower edge hangs {abs(hanging[0] - height(rest)[0]) * 1e6:.0f} µm from its place")

# %% [markdown]
# ## A picture

# %%
import matplotlib.pyplot as plt

figure, (left, right) = plt.subplots(1, 2, figsize=(8, 4), width_ratios=(3, 2), layout="constrained")
fine = np.linspace(0, HEIGHT, 200)
left.plot((stretch(fine) - 1) * 100, fine, label="closed form")
left.plot((stretches - 1) * 100, middles, "o", markersize=4, label="simulation, 20 rows")
left.set(xlabel="stretch [%]", ylabel="height at rest [m]")
left.legend()
x, y = simulation.points()[:, 0], simulation.points()[:, 1]
right.triplot(x, y, simulation.model.bodies[0].shell.triangles, linewidth=0.4)
right.plot([0, WIDTH, WIDTH, 0, 0], [0, 0, HEIGHT, HEIGHT, 0], "k--", linewidth=1)
right.set(aspect="equal", xlabel="x [m]", ylabel="y [m]", title="dashed: at rest")
figure.savefig("flag.png", dpi=120)

# %% [markdown]
# ![stretch over height, and the flag](flag.png)
#
# ## Finer is better
#
# Twice as many rows divide the error of the lower edge by nearly four: the discretisation is of second order.

# %%
errors = []
for rows in (10, 20, 40):
    rest, hanging, _ = measured(hang(rows))
    errors.append(abs(hanging[0] - height(rest)[0]))
    print(f"{rows:3} rows: {errors[-1] * 1000:.4f} mm")
print("ratios:", ", ".join(f"{coarse / fine:.2f}" for coarse, fine in zip(errors, errors[1:])))
