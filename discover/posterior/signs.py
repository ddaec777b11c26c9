"""How much of a normal density lies where signs allow it: in an orthant of some coefficients.

Where the nearest allowed place is about as probable as the most probable one, coefficients are cut
off at zero one after the other. Where it is far, the density falls from there on as an exponential,
and its integral is that place's own: cutting off one by one would let columns that are alike make
up for each other with a sign that neither may have, and miss by hundreds of nats either way.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.special import erfcx, log_ndtr

from models.checks import Array

Flags = NDArray[np.bool_]
_FAR = 3.0
"""Squared distance of the nearest allowed place, in standard deviations, from which it counts."""
_LEAST = 1e-300  # variance
_RIDGE = 1e-12  # of the variance: correlations of one, as of equal columns, have an inverse too
_TOUCHES = 1e-9  # standard deviations, by which a coefficient may be beyond zero
_LOG_2 = float(np.log(2.0))  # nats: a coefficient of known sign has half the places
_LOG_ROOT_2PI = 0.5 * float(np.log(2.0 * np.pi))  # of the normal density


def allowed(mean: Array, covariance: Array, sign: Array) -> Array:
    """Return the log of how much of a posterior (...,) its signs allow, over that of the prior.

    Parameters
    ----------
    mean : ndarray, shape (..., K)
        Of the coefficients.
    covariance : ndarray, shape (..., K, K)
        Of the coefficients.
    sign : ndarray, shape (..., K)
        1 where one can't be negative, -1 where not positive, else 0.
    """
    if not np.any(sign):
        return np.zeros(mean.shape[:-1])
    result = _one_by_one(mean, covariance, sign)
    count = mean.shape[-1]
    signs = np.broadcast_to(sign, mean.shape).reshape(-1, count)
    means = mean.reshape(-1, count)
    outside = np.any(signs * means < 0.0, axis=-1) & (np.sum(signs != 0.0, axis=-1) > 1)
    some = np.flatnonzero(outside & np.isfinite(result.reshape(-1)))
    if not some.size:
        return result
    covariances = covariance.reshape(-1, count, count)[some]
    around, distance = _around_nearest(means[some], covariances, signs[some])
    flat = result.reshape(-1).copy()
    flat[some] = np.where(distance > _FAR, around, flat[some])
    return flat.reshape(result.shape)


def _one_by_one(mean: Array, covariance: Array, sign: Array) -> Array:
    """Return `allowed` where little is cut off (Mendell and Elston, Biometrics 30, 1974).

    The others are what they are beside each that is cut off.
    """
    mean, covariance = mean.copy(), covariance.copy()
    result = np.zeros(mean.shape[:-1])
    for k in range(mean.shape[-1]):
        own = sign[..., k]
        if not np.any(own):
            continue
        variance = np.maximum(covariance[..., k, k], _LEAST)
        deviation = np.sqrt(variance)
        z = own * mean[..., k] / deviation
        inside = log_ndtr(z)
        ratio = np.exp(-0.5 * z**2 - _LOG_ROOT_2PI - inside)
        moved = np.where(own == 0.0, 0.0, ratio)
        result = result + np.where(own == 0.0, 0.0, _LOG_2 + inside)
        slope = covariance[..., :, k] / deviation[..., None]
        mean = mean + slope * (own * moved)[..., None]
        taken = np.clip(moved * (moved + z), 0.0, 1.0)
        covariance = covariance - (
            taken[..., None, None] * slope[..., :, None] * slope[..., None, :]
        )
    return result


def _around_nearest(mean: Array, covariance: Array, sign: Array) -> tuple[Array, Array]:
    """Return `allowed` (S,) by the density around the nearest allowed place, and how far that is.

    As a squared distance in standard deviations. Coefficients (S, K) that are zero there fall off
    as the density's slope has it, the others are cut off beside them.
    """
    turned = np.where(sign == 0.0, 1.0, sign)
    deviation = np.sqrt(np.maximum(np.diagonal(covariance, axis1=1, axis2=2), _LEAST))
    z = turned * mean / deviation
    scale = turned / deviation
    alike = scale[:, :, None] * covariance * scale[:, None, :]
    zero, push = _nearest(z, alike, sign != 0.0)
    both = zero[:, :, None] & zero[:, None, :]
    inverse = np.linalg.inv(_held(alike, zero))
    own = 1.0 / np.maximum(np.diagonal(inverse, axis1=1, axis2=2), _LEAST)
    at_zero = np.log(0.5 * erfcx(push * np.sqrt(0.5 * own))) + 0.5 * np.log(own)
    volume = np.linalg.slogdet(inverse)[1]
    other = np.where(zero[:, None, :], alike, 0.0)
    left = 1.0 - np.einsum("sij,sjk,sik->si", other, np.where(both, inverse, 0.0), other)
    place = z + np.einsum("sij,sj->si", alike, push)
    beside = log_ndtr(place / np.sqrt(np.maximum(left, _TOUCHES**2)))
    parts = np.where(zero, at_zero, np.where(sign == 0.0, 0.0, beside))
    distance = -np.sum(z * push, axis=-1)
    whole = np.sum(parts, axis=-1) + 0.5 * volume - 0.5 * distance
    return whole + _LOG_2 * np.sum(sign != 0.0, axis=-1), distance


def _nearest(z: Array, alike: Array, signed: Flags) -> tuple[Flags, Array]:
    """Return which coefficients (S, K) are zero at the nearest allowed place, and what holds them.

    `z` are means of variance one with correlations `alike` (S, K, K). What is pushed the wrong way
    is let go and what is beyond zero is held, all at once, later one at a time, which is sure to
    end (Murty, *Linear Complementarity*, 1988).
    """
    count = z.shape[1]
    zero = signed & (z < 0.0)
    push = np.zeros_like(z)
    for turn in range(5 * count):
        wanted = np.where(zero, -z, 0.0)[..., None]
        push = np.asarray(np.linalg.solve(_held(alike, zero), wanted)[..., 0], dtype=np.float64)
        place = z + np.einsum("sij,sj->si", alike, push)
        wrong = (zero & (push < 0.0)) | (signed & ~zero & (place < -_TOUCHES))
        if not np.any(wrong):
            break
        if turn >= count:
            last = np.cumsum(wrong[:, ::-1], axis=1)[:, ::-1] == 1
            wrong &= last
        zero = zero ^ wrong
    return zero, np.where(zero, np.maximum(push, 0.0), 0.0)


def _held(alike: Array, zero: Flags) -> Array:
    """Return correlations (S, K, K) of the coefficients that are zero, the others on their own."""
    one = np.eye(zero.shape[1])
    both = zero[:, :, None] & zero[:, None, :]
    return np.asarray(np.where(both, alike + _RIDGE * one, one))
