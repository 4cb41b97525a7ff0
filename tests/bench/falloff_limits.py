#!/usr/bin/env python3
"""falloff_limits.py: the limits and weights that stand for the smooth falloff (the rows
SURFELAO_MASK_LIMIT of tree/masks/constants.inc). Needs python3-scipy.

What is covered within the distance t, O(t), is asked at K distances; the sum of w_k O(t_k) is to be
the integral of O(t) times the loss of the weight (1 - t^2)^2 from t to t + dt. Least squares over an
endless wall beside the receiver, an endless ceiling above and one of twice the distance, at distances
from 0.02 to 1 times the limit. Prints RMSE, mean and largest error of each, for the best limits of
each number and for limits at equal steps of the weight."""

import numpy as np
from scipy.optimize import minimize

NEAR = np.exp(np.linspace(np.log(0.02), 0.0, 400))


def sine(t):
    return np.minimum(NEAR / t, 1.0)


def wall(t):
    x = sine(t)
    return 0.5 - (np.arcsin(x) + x * np.sqrt(1.0 - x * x)) / np.pi


def ceiling(t):
    return 1.0 - sine(t) ** 2


def disk(t):
    return 1.0 - np.maximum(sine(t), 1.0 / np.sqrt(5.0)) ** 2


SHAPES = [wall, ceiling, disk]


def at_weight(h):
    return np.sqrt(1.0 - np.sqrt(h))


def equal_steps(count):
    return (np.arange(count) + 0.5) / count


TRUE = [sum(shape(t) for t in at_weight(equal_steps(20000))) / 20000 for shape in SHAPES]


def errors(limits, weights):
    return [sum(w * shape(t) for w, t in zip(weights, limits)) - true
            for shape, true in zip(SHAPES, TRUE)]


def unpacked(numbers):
    limits, weights = np.split(np.abs(numbers), 2)
    order = np.argsort(limits)
    return limits[order], weights[order] / weights.sum()


def best(count):
    def cost(numbers):
        return sum(np.mean(e * e) for e in errors(*unpacked(numbers)))
    start = np.concatenate([at_weight(equal_steps(count)), np.full(count, 1.0 / count)])
    tries = [minimize(cost, start * (1.0 + 0.1 * np.random.RandomState(seed).randn(2 * count)),
                      method="Nelder-Mead", options={"maxfev": 10000, "xatol": 1e-4, "fatol": 1e-9})
             for seed in range(4)]
    return unpacked(min(tries, key=lambda found: found.fun).x)


def main():
    for count in (4, 5, 6, 8):
        equal = at_weight(equal_steps(count)), np.full(count, 1.0 / count)
        for name, (limits, weights) in (("best", best(count)), ("equal", equal)):
            found = ", ".join(f"{t:.3f} {w:.3f}" for t, w in zip(limits, weights))
            told = "   ".join(f"{np.sqrt(np.mean(e * e)):.4f} {e.mean():+.4f} {abs(e).max():.3f}"
                              for e in errors(limits, weights))
            print(f"{count} {name:5} {found}\n        {told}")


main()
