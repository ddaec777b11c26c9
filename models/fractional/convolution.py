"""Causal convolution of records with weights by padded FFT, the weights' spectra cached."""

from __future__ import annotations

import math
import threading
from collections import OrderedDict
from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np
import scipy.fft
from numpy.typing import NDArray

from models.fractional.orders import Array
from models.fractional.threads import map_threads

Complex = NDArray[np.complex128]
WeightMaker = Callable[[Array, int], Array]

Item = TypeVar("Item")

DEFAULT_CACHE_BYTES = 256 * 2**20
_PARTS = 4
# Weights made together, and their bytes at most.
_MADE_ROWS = 32
_MADE_BYTES = 2**25


class SpectrumCache:
    """Spectra of convolution weights, least recently used first out, bounded in bytes.

    Parameters
    ----------
    limit : int
        Bytes to keep.

    Examples
    --------
    >>> cache = SpectrumCache(1000)
    >>> cache.put(("gl", 0.5), np.zeros(10, dtype=complex))
    >>> cache.get(("gl", 0.5)).size
    10
    """

    def __init__(self, limit: int = DEFAULT_CACHE_BYTES) -> None:
        self._limit = limit
        self._bytes = 0
        self._rows: OrderedDict[object, Complex] = OrderedDict()
        self._lock = threading.Lock()

    def get(self, key: object) -> Complex | None:
        """Return the row kept under `key`, or None."""
        with self._lock:
            row = self._rows.get(key)
            if row is not None:
                self._rows.move_to_end(key)
            return row

    def put(self, key: object, row: Complex) -> None:
        """Keep `row` under `key`, dropping the longest unused ones where room is short."""
        with self._lock:
            if key in self._rows or row.nbytes > self._limit:
                return
            self._rows[key] = row
            self._bytes += row.nbytes
            while self._bytes > self._limit:
                _, dropped = self._rows.popitem(last=False)
                self._bytes -= dropped.nbytes

    def clear(self) -> None:
        """Forget everything."""
        with self._lock:
            self._rows.clear()
            self._bytes = 0


_CACHE = SpectrumCache()


def clear_cache() -> None:
    """Forget all cached weight spectra.

    Examples
    --------
    >>> clear_cache()
    """
    _CACHE.clear()


def padded_length(samples: int) -> int:
    """Return the FFT length at which no tail wraps round into the record.

    Examples
    --------
    >>> padded_length(100)
    200
    """
    return int(scipy.fft.next_fast_len(2 * samples - 1, real=True))


def weight_spectra(
    scheme: str, orders: Array, samples: int, make_weights: WeightMaker
) -> list[Complex]:
    """Return the spectra of the first `samples` weights of each order, from the cache or made.

    Parameters
    ----------
    scheme : str
        Name under which the weights are cached.
    orders : ndarray, shape (K,)
    samples : int
        Length N of the record.
    make_weights : callable
        Maps orders (k,) and a count to weights (k, count).

    Returns
    -------
    list of K ndarrays, each of shape (4, L // 2 + 1), complex
        Of the weights from the samples of a part of the record to those of the same part, of
        the next one, and so on.

    Examples
    --------
    >>> rows = weight_spectra("ones", np.array([0.0]), 8, lambda a, n: np.ones((a.size, n)))
    >>> rows[0][:, 0].real
    array([2., 3., 3., 3.])
    """
    size = _part(samples)
    length = padded_length(size)
    keys = [(scheme, float(order), samples) for order in orders]
    rows = [_CACHE.get(key) for key in keys]
    missing = [i for i, row in enumerate(rows) if row is None]

    def make(chosen: list[int]) -> Complex:
        weights = make_weights(orders[chosen], _PARTS * size).reshape(-1, _PARTS, size)
        kernels = np.zeros((len(chosen), _PARTS, length))
        kernels[:, :, :size] = weights
        # To a sample from one that lies further behind in its own part: a part less the way.
        kernels[:, 1:, length - size + 1 :] = weights[:, :-1, 1:]
        made: Complex = scipy.fft.rfft(kernels, axis=-1, workers=1)
        made.setflags(write=False)
        return made

    together = max(1, min(_MADE_ROWS, _MADE_BYTES // (8 * samples)))
    blocks = _blocks(missing, together)
    for chosen, made in zip(blocks, map_threads(make, blocks), strict=True):
        for i, row in zip(chosen, made, strict=True):
            rows[i] = row
            _CACHE.put(keys[i], row)
    return [row for row in rows if row is not None]


def convolve(
    sources: Array,
    choice: NDArray[np.intp],
    spectra: Sequence[Complex | None],
    scales: Array,
) -> Array:
    """Convolve records causally with the weights of each order.

    The record is cut into parts, each transformed by itself and combined with all before it:
    short transforms stay in the processor's cache and take several parts at once.

    Parameters
    ----------
    sources : ndarray, shape (V, R, N)
        Variants of R records.
    choice : ndarray of int, shape (K,)
        The variant that each order works on.
    spectra : sequence of K ndarrays, shape (4, L // 2 + 1), or None
        From `weight_spectra` for N samples; None leaves the records as they are.
    scales : ndarray, shape (K,)
        Factor of each order.

    Returns
    -------
    ndarray, shape (K, R, N)

    Examples
    --------
    >>> rows = weight_spectra("ones", np.array([0.0]), 4, lambda a, n: np.ones((a.size, n)))
    >>> x = np.array([[[1.0, 2.0, 3.0, 4.0]]])
    >>> convolve(x, np.array([0]), rows, np.array([1.0])).round(12)
    array([[[ 1.,  3.,  6., 10.]]])
    """
    _, records, samples = sources.shape
    size = _part(samples)
    length = padded_length(size)
    out = np.empty((len(spectra), records, samples))
    jobs = []
    for k, spectrum in enumerate(spectra):
        if spectrum is None:
            np.multiply(sources[choice[k]], scales[k], out=out[k])
        else:
            jobs += [(spectrum, k, r) for r in range(records)]
    if not jobs:
        return out
    places = [slice(min(i * size, samples), min((i + 1) * size, samples)) for i in range(_PARTS)]
    padded = np.zeros((*sources.shape[:2], _PARTS, length))
    for i, place in enumerate(places):
        padded[:, :, i, : place.stop - place.start] = sources[:, :, place]
    transformed = scipy.fft.rfft(padded, axis=-1)
    del padded

    def work(share: list[tuple[Complex, int, int]]) -> None:
        # One product may overwrite what it is made of, the last part first.
        products = transformed[0, 0]
        if len(jobs) * len(sources) * records > 1:
            products = np.empty_like(products)
        term = np.empty_like(products[0])
        for spectrum, k, r in share:
            parts = transformed[choice[k], r]
            for i in range(_PARTS - 1, -1, -1):
                np.multiply(spectrum[0], parts[i], out=products[i])
                for j in range(i):
                    np.multiply(spectrum[i - j], parts[j], out=term)
                    products[i] += term
            values = scipy.fft.irfft(products, n=length, axis=-1, workers=1)
            for row, place in zip(values, places, strict=True):
                np.multiply(row[: place.stop - place.start], scales[k], out=out[k, r, place])

    shares = max(1, min(int(scipy.fft.get_workers()), len(jobs)))
    map_threads(work, _blocks(jobs, math.ceil(len(jobs) / shares)))
    return out


def _part(samples: int) -> int:
    """Return how many samples a part of a record has; the last ones may have less."""
    return -(-samples // _PARTS)


def _blocks(items: Sequence[Item], size: int) -> list[list[Item]]:
    """Split into blocks of `size`, the last one shorter."""
    return [list(items[start : start + size]) for start in range(0, len(items), size)]
