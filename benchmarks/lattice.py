"""The generating vector of the quasi-random points: built one component after the other, as its
source describes.

    python benchmarks/lattice.py

prints the vector in ``collisions/uncertainty/designs.py`` and how evenly its points fill the cube
against independent ones. The construction is that of R. Cools, F. Y. Kuo, D. Nuyens, "Constructing
embedded lattice rules for multivariate integration", SIAM J. Sci. Comput. 28 (2006): each component
is the candidate with the least squared worst-case error in a weighted Korobov space of smoothness
2, here by the mean of its logarithm over the sizes below, so that every power of two is served. All
inputs weigh the same, because the order in which an analyst names them means nothing.
"""

import numpy as np

BITS = 20
SIZES = (2**6, 2**9, 2**12, 2**15)
CANDIDATES = 400
WEIGHT = 0.02


def kernel(x: np.ndarray) -> np.ndarray:
    """The reproducing kernel less 1, 2 pi^2 B_2(x): its mean over the cube is 0."""
    return 2.0 * np.pi**2 * (x * (x - 1.0) + 1.0 / 6.0)


def build(count: int, seed: int = 2006) -> list[int]:
    """The components, the first of which is 1."""
    random = np.random.default_rng(seed)
    index = {size: np.arange(size) for size in SIZES}
    product = {size: np.ones(size) for size in SIZES}
    vector: list[int] = []
    for _ in range(count):
        candidates = (
            [1]
            if not vector
            else sorted({int(z) | 1 for z in random.integers(3, 2**BITS, CANDIDATES)} - set(vector))
        )
        scores = [
            sum(
                np.log(np.mean(product[size] * factor(index[size], z, size)) - 1.0)
                for size in SIZES
            )
            for z in candidates
        ]
        best = candidates[int(np.argmin(scores))]
        vector.append(best)
        for size in SIZES:
            product[size] *= factor(index[size], best, size)
    return vector


def factor(index: np.ndarray, z: int, size: int) -> np.ndarray:
    return 1.0 + WEIGHT * kernel((index * z % size) / size)


if __name__ == "__main__":
    found = build(64)
    print(found)
    for size in SIZES:
        lattice = (
            np.mean(np.prod([factor(np.arange(size), z, size) for z in found[:10]], axis=0)) - 1.0
        )
        # The mean over independent points: only the diagonal of the double sum stays.
        independent = ((1.0 + WEIGHT * kernel(np.zeros(1))[0]) ** 10 - 1.0) / size
        print(
            size,
            "points in 10 dimensions: error against independent points",
            f"{np.sqrt(lattice / independent):.3g}",
        )
