"""Derivatives of records of any length in one pass, with a state of fixed size."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
import scipy.fft
from numpy.typing import ArrayLike, NDArray

from models.checks import finite_array, number, one_of
from models.fractional.causal import add_steps, start_corrections, taylor
from models.fractional.correction import HEAD_SAMPLES, MOMENTS, end_corrections
from models.fractional.differences import (
    Split,
    backward_difference,
    reach,
    split_orders,
    started_derivative,
)
from models.fractional.memory_modes import MemoryModes, memory_modes
from models.fractional.orders import Array, checked_orders
from models.fractional.quadrature import best_quadrature
from models.fractional.start import LONGEST, Start, fit_start
from models.fractional.weights import BDF_STEPS, HEAD, INTEGRAL_STEPS, convolution_weights

_KINDS = ("caputo", "riemann-liouville")
_BLOCK = 4096


@dataclass(frozen=True)
class StreamOperator:
    """What does not change from chunk to chunk."""

    orders: Array
    """(K,)"""
    dt: float
    """Sampling interval, s."""
    caputo: bool
    """Caputo, else Riemann-Liouville."""
    steps: int
    """Steps of the backward difference formula."""
    stride: int
    """Samples from one point of the backward differences to the next."""
    split: Split
    """Orders as whole derivatives and integrals of them."""
    spectra: NDArray[np.complex128]
    """(K, L // 2 + 1) of the weights that act within buffer and block."""
    modes: MemoryModes
    """Memory of what lies further back."""
    powers: Array
    """(M, block + 1) exp(-rate q)."""


@dataclass(frozen=True)
class StreamState:
    """All that is kept of the past."""

    seen: int
    """Samples taken in."""
    start: Start
    """The motion at the first sample."""
    samples: Array
    """The latest samples, as many as the backward differences look back."""
    recent: Array
    """(V, 512) the latest whole derivatives."""
    memory: Array
    """(V, M) modes of all whole derivatives before those."""


def stream_operator(
    orders: ArrayLike, dt: float, *, kind: str = "caputo", scheme: str = "bdf4", stride: int = 1
) -> StreamOperator:
    """Prepare derivatives in one pass.

    Parameters
    ----------
    orders : array_like, shape (K,)
        Orders, -1 to 2.
    dt : float
        Sampling interval, s.
    kind : {"caputo", "riemann-liouville"}, optional
    scheme : {"gl", "bdf2", ..., "bdf6"}, optional
    stride : int, optional
        Samples from one point of the backward differences to the next.

    Returns
    -------
    StreamOperator

    Raises
    ------
    InputError
        For unknown kinds or schemes, orders outside [-1, 2], dt <= 0 or a stride below 1.

    Examples
    --------
    >>> stream_operator([0.5], 0.01).modes.rates.size < 250
    True
    """
    alpha, _ = checked_orders(orders)
    step = number("dt", dt, above=0.0)
    one_of("kind", kind, _KINDS)
    steps = BDF_STEPS[one_of("scheme", scheme, BDF_STEPS)]
    split = split_orders(alpha)
    modes = memory_modes(split.rest, INTEGRAL_STEPS)
    weights = convolution_weights(split.rest, HEAD + _BLOCK, INTEGRAL_STEPS)
    return StreamOperator(
        orders=alpha,
        dt=step,
        caputo=kind == "caputo",
        steps=steps,
        stride=int(number("stride", stride, at_least=1.0)),
        split=split,
        spectra=np.asarray(scipy.fft.rfft(weights, n=_transform_length(), axis=-1)),
        modes=modes,
        powers=np.exp(-np.outer(modes.rates, np.arange(_BLOCK + 1))),
    )


def begin(operator: StreamOperator, first: ArrayLike) -> StreamState:
    """Return the state before the first sample, its start fitted to the samples that follow.

    Parameters
    ----------
    operator : StreamOperator
    first : array_like, shape (n,)
        The first samples; 32,768 of them give the start that a whole record gives.

    Returns
    -------
    StreamState

    Examples
    --------
    >>> state = begin(stream_operator([0.5], 0.01), np.arange(30.0))
    >>> bool(np.allclose(state.start.motion[:3], [0, 1, 0]))
    True
    """
    variants = len(operator.split.wholes)
    return StreamState(
        seen=0,
        start=fit_start(finite_array("first", first, ndim=1)),
        samples=np.zeros(reach(operator.split.wholes[-1], operator.steps, operator.stride)),
        recent=np.zeros((variants, HEAD)),
        memory=np.zeros((variants, operator.modes.rates.size)),
    )


def advance(
    operator: StreamOperator, state: StreamState, chunk: ArrayLike
) -> tuple[StreamState, Array]:
    """Take in the next samples.

    Parameters
    ----------
    operator : StreamOperator
    state : StreamState
    chunk : array_like, shape (n,)
        Any number of samples.

    Returns
    -------
    state : StreamState
        To go on with; the one passed in is not changed.
    values : ndarray, shape (K, n)
        The derivatives at these samples, as of the whole record.

    Raises
    ------
    InputError
        For values that are not finite.

    Examples
    --------
    >>> t = 0.01 * np.arange(2000)
    >>> operator = stream_operator([1.0], 0.01)
    >>> state = begin(operator, t[:1000] ** 2)
    >>> state, first = advance(operator, state, t[:1000] ** 2)
    >>> state, second = advance(operator, state, t[1000:] ** 2)
    >>> bool(np.allclose(second[0], 2 * t[1000:]))
    True
    """
    x = finite_array("chunk", chunk, ndim=1, min_size=0)
    out = np.empty((operator.orders.size, x.size))
    for start in range(0, x.size, _BLOCK):
        block = x[start : start + _BLOCK]
        state = _advance_block(operator, state, block, out[:, start : start + block.size])
    return state, out


def stream_derivative(
    chunks: Iterable[ArrayLike],
    orders: ArrayLike,
    dt: float,
    *,
    kind: str = "caputo",
    scheme: str = "auto",
) -> Iterator[Array]:
    """Differentiate a record that comes in chunks.

    The first chunks are held back until there are 32,768 samples (or no more come), for the fit
    of the start and the choice of the scheme; after that each chunk gives its result at once.

    Parameters
    ----------
    chunks : iterable of array_like, shape (n_i,)
        Consecutive samples.
    orders : array_like, shape (K,)
        Orders, -1 to 2.
    dt : float
        Sampling interval, s.
    kind : {"caputo", "riemann-liouville"}, optional
    scheme : {"auto", "gl", "bdf2", ..., "bdf6"}, optional
        "auto" balances truncation against noise in the samples held back; it seeks no kinks.

    Yields
    ------
    ndarray, shape (K, n_i)
        One for each chunk; together what `derivative` gives of the whole record with the same
        scheme.

    Raises
    ------
    InputError
        As `stream_operator` and `advance`.

    Examples
    --------
    >>> x = np.sin(0.01 * np.arange(1000))
    >>> parts = stream_derivative(np.split(x, 4), [0.5], 0.01)
    >>> [part.shape for part in parts]
    [(1, 250), (1, 250), (1, 250), (1, 250)]
    """
    alpha, _ = checked_orders(orders)
    one_of("scheme", scheme, ("auto", *BDF_STEPS))
    source = iter(chunks)
    held: list[Array] = []
    for chunk in source:
        held.append(finite_array("chunk", chunk, ndim=1, min_size=0))
        if sum(part.size for part in held) >= LONGEST:
            break
    if not held or all(part.size == 0 for part in held):
        yield from (np.empty((alpha.size, 0)) for _ in held)
        return
    first = np.concatenate(held)
    stride = 1
    if scheme == "auto":
        best = best_quadrature(first[None], alpha, [[fit_start(first)]])
        scheme, stride = best.scheme, best.stride
    operator = stream_operator(alpha, dt, kind=kind, scheme=scheme, stride=stride)
    state = begin(operator, first)
    for part in held:
        state, values = advance(operator, state, part)
        yield values
    for chunk in source:
        state, values = advance(operator, state, chunk)
        yield values


def _transform_length() -> int:
    """FFT length for a block behind its buffer: no tail reaches the block's own outputs."""
    return int(scipy.fft.next_fast_len(HEAD + 2 * _BLOCK, real=True))


def _advance_block(
    operator: StreamOperator, state: StreamState, block: Array, out: Array
) -> StreamState:
    """Write the derivatives at up to one block of samples into `out`; return the next state."""
    size, seen, split = block.size, state.seen, operator.split
    samples = np.concatenate([state.samples, block])
    sources = np.stack([_source(operator, state, samples, whole) for whole in split.wholes])
    joined = np.concatenate([state.recent, sources], axis=1)
    transformed = scipy.fft.rfft(joined, n=_transform_length(), axis=-1)
    for j, variant in enumerate(split.choice):
        row = scipy.fft.irfft(operator.spectra[j] * transformed[variant], n=_transform_length())
        out[j] = row[HEAD : HEAD + size]
    out += (operator.modes.weights * state.memory[split.choice]) @ operator.powers[:, 1 : size + 1]
    if seen < HEAD_SAMPLES:
        heads = start_corrections(state.start, split)[:, seen : seen + size]
        out[:, : heads.shape[1]] += heads
    scales = operator.dt**-operator.orders
    out *= scales[:, None]
    if not operator.caputo:
        add_steps(out, state.start, operator.orders, scales, seen)
    # What leaves the buffer enters the modes, the latest with weight one.
    leaving = joined[:, :size][:, ::-1]
    return StreamState(
        seen=seen + size,
        start=state.start,
        samples=samples[size:].copy(),
        recent=joined[:, size:].copy(),
        memory=state.memory * operator.powers[:, size] + leaving @ operator.powers[:, :size].T,
    )


def _source(operator: StreamOperator, state: StreamState, samples: Array, whole: int) -> Array:
    """Whole derivative of a block behind the samples before it, with the start's correction."""
    seen, past = state.seen, state.samples.size
    how = whole, operator.steps, operator.stride
    source = backward_difference(samples, *how, past=past)
    behind = reach(*how)
    if seen < behind:
        from_start = samples[past - seen : past - seen + behind]
        started = started_derivative(from_start, state.start, *how)[seen:]
        source[: started.size] = started
    if seen < MOMENTS:
        ends = (taylor(state.start, whole) @ end_corrections())[seen : seen + source.size]
        source[: ends.size] += ends
    return source
