"""Particle filters: resampling, the number of particles, and the pose of a thing that moves."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from scipy.stats import chi2

from deixis.perception.tracking.settings import ParticleSettings
from deixis.perception.tracking.things.particles import ParticleFilter, kld_samples, systematic_resample, turned_by

WEIGHTS = st.lists(st.floats(0, 1), min_size=1, max_size=20).filter(lambda weights: sum(weights) > 1e-3)


def naive(weights: np.ndarray, count: int, start: float) -> list[int]:
    """Resample by walking along the weights, independently of the implementation."""
    drawn, at, total = [], 0, weights[0] / weights.sum()
    for step in range(count):
        while (start + step) / count >= total and at < len(weights) - 1:
            at += 1
            total += weights[at] / weights.sum()
        drawn.append(at)
    return drawn


@given(WEIGHTS, st.integers(1, 50), st.integers(0, 1000))
@settings(max_examples=60, deadline=None)
def test_resampled_counts_are_exact_within_one(weights: list[float], count: int, seed: int) -> None:
    given_weights = np.array(weights)
    drawn = systematic_resample(given_weights, count, np.random.default_rng(seed))
    expected = count * given_weights / given_weights.sum()
    counts = np.bincount(drawn, minlength=len(weights))
    assert (np.abs(counts - expected) < 1 + 1e-6).all()
    assert (np.diff(drawn) >= 0).all() and not counts[expected < 1e-12].any()


def test_resampling_agrees_with_an_independent_one() -> None:
    rng = np.random.default_rng(3)
    for trial in range(50):
        weights = rng.random(rng.integers(1, 30)) ** 3
        drawn = systematic_resample(weights, 40, np.random.default_rng(trial))
        assert drawn.tolist() == naive(weights, 40, np.random.default_rng(trial).random())


def test_resampling_is_unbiased() -> None:
    weights = np.array([0.13, 0.5, 0.02, 0.35])
    drawn = [systematic_resample(weights, 7, np.random.default_rng(seed)) for seed in range(4000)]
    mean = np.bincount(np.concatenate(drawn), minlength=4) / 4000
    assert mean == pytest.approx(7 * weights, abs=0.03)


@pytest.mark.parametrize("bins", [2, 10, 100, 1000])
def test_number_of_particles_follows_the_chi_squared_law(bins: int) -> None:
    exact = chi2.ppf(0.99, bins - 1) / (2 * 0.05)
    assert kld_samples(bins, 0.05, 2.326) == pytest.approx(exact, rel=0.06)


def test_turns_compose_like_rotations() -> None:
    rng = np.random.default_rng(1)
    vectors, turns = rng.normal(size=(20, 3)), Rotation.random(20, random_state=2)
    found = Rotation.from_quat(turned_by(vectors, turns.as_quat()[:, [3, 0, 1, 2]])[:, [1, 2, 3, 0]])
    assert (found * (Rotation.from_rotvec(vectors) * turns).inv()).magnitude().max() < 1e-6


def test_filter_finds_the_best_pose_and_adapts_its_size() -> None:
    target, options = np.array([0.02, -0.03, 0.01]), ParticleSettings()
    particles = ParticleFilter(np.eye(4), options, seed=1)

    def weigh(places: np.ndarray, turns: np.ndarray) -> np.ndarray:
        away = ((places - target) ** 2).sum(axis=1) / 0.01**2 + (1 - turns[:, 0] ** 2) / 0.05**2
        return np.asarray(np.exp(-away / 2))

    found = [particles.step(weigh, None, 0.0) for _ in range(3)][-1]
    assert np.linalg.norm(found.place - target) < 0.004
    narrow = ParticleFilter(np.eye(4), ParticleSettings(shift=0.001, turn=0.01), seed=1)
    assert narrow.step(weigh, None, 0.0).particles < found.particles
