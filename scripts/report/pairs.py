"""Statistics of times that were measured in pairs. Standard library only; the same figures give the
same answers."""

import itertools
import math
import random
import statistics

RESAMPLES = 2000


def median_interval(values, share=0.95):
    """Bootstrap interval of the median (percentiles); None for fewer than two values."""
    if len(values) < 2:
        return None
    chance = random.Random(20180904)
    medians = sorted(statistics.median(chance.choices(values, k=len(values)))
                     for _ in range(RESAMPLES))
    cut = int((1 - share) / 2 * RESAMPLES)
    return [medians[cut], medians[RESAMPLES - 1 - cut]]


def ratio(above, below):
    """Median of above[i] / below[i] with its interval."""
    ratios = [a / b for a, b in zip(above, below)]
    return {"median": statistics.median(ratios), "interval": median_interval(ratios),
            "pairs": len(ratios)}


def same_against_same(times):
    """Successive times of one setting as pairs, each other pair turned round: an A/A run."""
    pairs = [times[i:i + 2] for i in range(0, len(times) - 1, 2)]
    pairs = [pair if i % 2 == 0 else pair[::-1] for i, pair in enumerate(pairs)]
    return pairs


def mann_whitney(a, b):
    """Two-sided p: exact for small samples, by the normal approximation with ties else."""
    values = sorted(a + b)
    rank = {v: (values.index(v) + 1 + len(values) - values[::-1].index(v)) / 2 for v in set(values)}
    total = sum(rank[v] for v in a)
    mean = len(a) * (len(values) + 1) / 2
    if math.comb(len(values), len(a)) <= 20000:
        ranks = [rank[v] for v in values]
        sums = [sum(pick) for pick in itertools.combinations(ranks, len(a))]
        return sum(abs(s - mean) >= abs(total - mean) - 1e-9 for s in sums) / len(sums)
    ties = sum(n ** 3 - n for n in (values.count(v) for v in set(values)))
    n = len(values)
    variance = len(a) * len(b) / 12 * (n + 1 - ties / (n * (n - 1)))
    if variance <= 0:
        return 1.0
    return math.erfc(max(0.0, abs(total - mean) - 0.5) / math.sqrt(2 * variance))
