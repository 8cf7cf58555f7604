"""Compiled loops of the tracker over pixels and particles."""

from __future__ import annotations

import numpy as np
from numba import njit

SAME, NEARER, FARTHER, COLOUR, MISSING, UNKNOWN, EDGE = 0, 1, 2, 3, 4, 5, 6
"""States of a pixel: as in the reference, something nearer, something farther, another colour at the same depth, no
measurement, and a pixel without a reference. In counts, ``EDGE`` is a pixel that is as one of another owner beside it,
under a camera that moves; its own state is ``SAME``."""

STATES = 7

VOID = 2
"""Distance in pixels within which a pixel must have a depth for one without a depth to be noise."""

FOLLOWING = np.float32(0.3)
"""Share of a new measurement in the last depth of a pixel, under a camera that moves."""


@njit(cache=True, nogil=True)
def depths(points, row, offset):  # type: ignore[no-untyped-def]
    """Return the depths (r, c) of points (r, c, 3) along the optical axis ``row`` (3,), 0 where there is none."""
    rows, columns = points.shape[:2]
    found = np.zeros((rows, columns), np.float32)
    for i in range(rows):
        for j in range(columns):
            z = points[i, j, 0] * row[0] + points[i, j, 1] * row[1] + points[i, j, 2] * row[2] + offset
            if z > 0:  # NaN is not
                found[i, j] = z
    return found


@njit(cache=True, nogil=True)
def compared(  # type: ignore[no-untyped-def]
    depth, colour, reference, shade, labels, level, count, tolerance, noise, least_colour, reach, bins
):
    """Return the state of each pixel (r, c), and how many pixels of each label are in each state.

    Pixels without a reference that show the table (depths ``level``, colours in ``bins``) get the reference of the
    table. ``reach`` is the distance in pixels within which an equal depth of the reference is looked for.
    """
    rows, columns = depth.shape
    state = np.empty((rows, columns), np.uint8)
    counts = np.zeros((count + 1, STATES), np.int64)
    square = least_colour * least_colour
    step = len(bins) / np.float32(256)
    for i in range(rows):
        for j in range(columns):
            z, label = depth[i, j], labels[i, j]
            beside = False
            near = max(tolerance, noise * z * z)
            if z <= 0:
                found = MISSING
            elif reference[i, j] <= 0:
                found = UNKNOWN
                r, g, b = int(colour[i, j, 0] * step), int(colour[i, j, 1] * step), int(colour[i, j, 2] * step)
                if abs(z - level[i, j]) < near and bins[r, g, b]:
                    reference[i, j], labels[i, j], label = level[i, j], 0, 0
                    for k in range(3):
                        shade[i, j, k] = colour[i, j, k]
                    found = SAME
            else:
                found = _state(z, colour[i, j], reference[i, j], shade[i, j], near, square)
                if found != SAME and reach > 0:
                    beside = True
                    for m in range(max(i - reach, 0), min(i + reach + 1, rows)):
                        for n in range(max(j - reach, 0), min(j + reach + 1, columns)):
                            if not beside or reference[m, n] <= 0 or (found == SAME and labels[m, n] != label):
                                continue
                            if _state(z, colour[i, j], reference[m, n], shade[m, n], near, square) == SAME:
                                found, beside = SAME, labels[m, n] != label
            state[i, j] = found
            if label >= 0:
                counts[label, EDGE if found == SAME and beside else found] += 1
    return state, counts


@njit(cache=True, nogil=True)
def _state(z, colour, reference, shade, near, square):  # type: ignore[no-untyped-def]
    if z < reference - near:
        return NEARER
    if z > reference + near:
        return FARTHER
    apart = 0.0
    for k in range(3):
        apart += (colour[k] - shade[k]) ** 2
    return COLOUR if apart > square else SAME


@njit(cache=True, nogil=True)
def remembered(  # type: ignore[no-untyped-def]
    state, depth, colour, reference, shade, offset, last, aside, since, at, tolerance, noise, least_colour, rate
):
    """Move the reference of unchanged pixels towards what is measured, and record since when each depth is steady.

    ``offset`` (r, c, 2) and ``aside`` (r, c, 2) are how far the points of the reference and the last depths lie from
    the middles of their pixels.
    """
    rows, columns = depth.shape
    square = least_colour * least_colour
    for i in range(rows):
        for j in range(columns):
            z = depth[i, j]
            if z <= 0:
                continue
            near = max(tolerance, noise * z * z)
            same = state[i, j] == SAME and reference[i, j] > 0
            if same and _state(z, colour[i, j], reference[i, j], shade[i, j], near, square) == SAME:
                reference[i, j] += rate * (z - reference[i, j])
                for k in range(3):
                    shade[i, j, k] += rate * (colour[i, j, k] - shade[i, j, k])
                offset[i, j, 0] *= 1 - rate
                offset[i, j, 1] *= 1 - rate
            if abs(z - last[i, j]) > near:
                since[i, j], last[i, j] = at, z
                aside[i, j, 0] = aside[i, j, 1] = 0
            elif aside[i, j, 0] != 0 or aside[i, j, 1] != 0:
                last[i, j] += FOLLOWING * (z - last[i, j])
                aside[i, j, 0] *= 1 - FOLLOWING
                aside[i, j, 1] *= 1 - FOLLOWING


@njit(cache=True, nogil=True)
def carried(depth, offset, labels, turn, shift, gap):  # type: ignore[no-untyped-def]
    """Return the pixels (r, c) of one view that other pixels of an earlier view show, with their depths and offsets.

    Each pixel of the earlier view is a point with a depth and an ``offset`` (r, c, 2), in columns and rows, from the
    middle of the pixel. Of two points in one new pixel, the nearer one is taken. A gap between two pixels of one
    surface and of one label is filled.

    Parameters
    ----------
    depth, offset
        Points of the earlier view; 0 where there is none.
    labels
        Label (r, c) of each of them.
    turn, shift
        Change (3, 3) and (3,) of homogeneous pixel coordinates from the earlier view to the new one.
    gap
        Difference of depths of two surfaces.
    """
    rows, columns = depth.shape
    source = np.full((rows, columns), -1, np.int32)
    found = np.zeros((rows, columns), np.float32)
    aside = np.zeros((rows, columns, 2), np.float32)
    for i in range(rows):
        for j in range(columns):
            z = depth[i, j]
            if z <= 0:
                continue
            u, v = j + offset[i, j, 0], i + offset[i, j, 1]
            d = z * (turn[2, 0] * u + turn[2, 1] * v + turn[2, 2]) + shift[2]
            if d <= 0:
                continue
            x = (z * (turn[0, 0] * u + turn[0, 1] * v + turn[0, 2]) + shift[0]) / d
            y = (z * (turn[1, 0] * u + turn[1, 1] * v + turn[1, 2]) + shift[1]) / d
            n, m = int(np.floor(x + 0.5)), int(np.floor(y + 0.5))
            if m < 0 or n < 0 or m >= rows or n >= columns or 0 < found[m, n] <= d:
                continue
            source[m, n], found[m, n] = i * columns + j, d
            aside[m, n, 0], aside[m, n, 1] = x - n, y - m
    for i in range(1, rows - 1):
        for j in range(1, columns - 1):
            if source[i, j] >= 0:
                continue
            for m, n in ((i, j - 1), (i - 1, j)):
                p, q = source[m, n], source[2 * i - m, 2 * j - n]
                if p < 0 or q < 0 or labels[p // columns, p % columns] != labels[q // columns, q % columns]:
                    continue
                if abs(found[m, n] - found[2 * i - m, 2 * j - n]) < gap:
                    source[i, j], found[i, j] = p, (found[m, n] + found[2 * i - m, 2 * j - n]) / 2
                    break
    return source, found, aside


@njit(cache=True, nogil=True)
def connected(mask, depth, gap):  # type: ignore[no-untyped-def]
    """Return the component of each pixel of a mask (r, c), from 1, and their number.

    Neighbouring pixels whose depths differ by more than ``gap`` are not connected, and pixels without depth are in no
    component.
    """
    rows, columns = mask.shape
    of = np.zeros((rows, columns), np.int32)
    stack = np.empty(rows * columns, np.int64)
    number = 0
    for i in range(rows):
        for j in range(columns):
            if not mask[i, j] or of[i, j] or depth[i, j] <= 0:
                continue
            number += 1
            of[i, j], size, stack[0] = number, 1, i * columns + j
            while size:
                size -= 1
                y, x = stack[size] // columns, stack[size] % columns
                for m in range(max(y - 2, 0), min(y + 3, rows)):
                    for n in range(max(x - 2, 0), min(x + 3, columns)):
                        if not mask[m, n] or of[m, n] or depth[m, n] <= 0:
                            continue
                        if abs(depth[m, n] - depth[y, x]) < gap:
                            of[m, n] = number
                            stack[size] = m * columns + n
                            size += 1
    return of, number


@njit(cache=True, nogil=True)
def _rotation(turn):  # type: ignore[no-untyped-def]
    """Return the rows of the rotation matrix of a unit quaternion (4,), real part first."""
    w, x, y, z = turn
    return (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )


@njit(cache=True, nogil=True)
def scores(  # type: ignore[no-untyped-def]
    places, turns, points, colours, matrix, offset, depth, colour, taken, tolerance, noise, shade, spread, hidden, empty
):
    """Return the mean score of each particle (n,), and how many of its points are seen, not hidden, and in the image.

    A point is seen if its distance agrees within 1.8 standard deviations and its colour within 1.5. One closely behind
    a surface of another colour, such as a finger, is hidden.

    A point of the thing that is at the measured depth scores up to 1, by its distance and its colour. A point behind
    the measured surface may be hidden: it scores ``hidden``. A point in front of it would be seen and is not: it scores
    ``empty``. A surface that belongs to something else (``taken``) does not count as the thing's. A pixel without a
    depth may be noise (``hidden``), but where none around it has one, nothing is near enough to be measured.

    Parameters
    ----------
    places, turns
        Positions (n, 3) and unit quaternions (n, 4), real part first, of the particles.
    points, colours
        Points (m, 3) of the thing in its own frame, and their colours.
    matrix, offset
        Projection of the points of the table's frame: homogeneous pixel coordinates, the last of which is the depth.
    depth, colour, taken
        Image that was measured, and a mask of the pixels that belong to something else.
    tolerance, noise
        Standard deviation of the distance: at least the first, and the second times the squared depth.
    shade, spread
        Standard deviations of the colours: of their lengths, which change with the light, and across.
    hidden, empty
        Scores of points that may be hidden, and of points where nothing is.
    """
    rows, columns = depth.shape
    found = np.zeros(len(places))
    seen = np.zeros((len(places), 3))
    for p in range(len(places)):
        (r00, r01, r02), (r10, r11, r12), (r20, r21, r22) = _rotation(turns[p])
        total = 0.0
        for i in range(len(points)):
            a, b, c = points[i]
            u = r00 * a + r01 * b + r02 * c + places[p, 0]
            v = r10 * a + r11 * b + r12 * c + places[p, 1]
            t = r20 * a + r21 * b + r22 * c + places[p, 2]
            d = matrix[2, 0] * u + matrix[2, 1] * v + matrix[2, 2] * t + offset[2]
            if d <= 0:
                total += hidden
                continue
            col = (matrix[0, 0] * u + matrix[0, 1] * v + matrix[0, 2] * t + offset[0]) / d
            row = (matrix[1, 0] * u + matrix[1, 1] * v + matrix[1, 2] * t + offset[1]) / d
            m, n = int(np.floor(row + 0.5)), int(np.floor(col + 0.5))
            if m < 0 or n < 0 or m >= rows or n >= columns:
                total += hidden
                continue
            seen[p, 2] += 1
            measured = depth[m, n]
            if measured <= 0:
                if _is_void(depth, m, n):
                    seen[p, 1] += 1
                    total += 0.5 * empty
                else:
                    total += hidden
                continue
            sigma = max(tolerance, noise * measured * measured)
            apart = measured - d
            if apart < -3 * sigma:
                total += hidden
                continue
            if apart > 3 * sigma:
                seen[p, 1] += 1
                total += empty
                continue
            if taken[m, n]:
                seen[p, 1] += 1
                total += 0.5 * empty
                continue
            own, other, both = 0.0, 0.0, 0.0
            for k in range(3):
                own += colours[i, k] ** 2
                other += colour[m, n, k] ** 2
                both += colours[i, k] * colour[m, n, k]
            hue = max(other - both * both / own, 0.0) if own > 0 else other
            tint = (np.sqrt(own) - np.sqrt(other)) ** 2 / (shade * shade) + hue / (spread * spread)
            if apart < -sigma and tint > 4.0:
                total += hidden
                continue
            seen[p, 1] += 1
            one = np.exp(-0.5 * (apart / sigma) ** 2) * (0.25 + 0.75 * np.exp(-0.5 * tint))
            total += one
            if apart * apart < 3.2 * sigma * sigma and tint < 2.25:
                seen[p, 0] += 1
        found[p] = total / max(len(points), 1)
    return found, seen


@njit(cache=True, nogil=True)
def _is_void(depth, row, column):  # type: ignore[no-untyped-def]
    """Return True if neither a pixel nor any near it has a depth."""
    rows, columns = depth.shape
    for m in range(max(row - VOID, 0), min(row + VOID + 1, rows)):
        for n in range(max(column - VOID, 0), min(column + VOID + 1, columns)):
            if depth[m, n] > 0:
                return False
    return True


@njit(cache=True, nogil=True)
def covered(places, turns, points, centre, yaw, half):  # type: ignore[no-untyped-def]
    """Return the share (n,) of points that are within the box of a thing, for each of its poses.

    Parameters
    ----------
    places, turns
        Positions (n, 3) and unit quaternions (n, 4), real part first, of the poses.
    points
        Points (m, 3) in the table's frame.
    centre, yaw, half
        Middle (3,) of the box in the thing's own frame, its turn about the vertical, and half of its sides (3,).
    """
    cosine, sine = np.cos(yaw), np.sin(yaw)
    found = np.zeros(len(places))
    for p in range(len(places)):
        (r00, r01, r02), (r10, r11, r12), (r20, r21, r22) = _rotation(turns[p])
        count = 0
        for i in range(len(points)):
            u, v, t = points[i, 0] - places[p, 0], points[i, 1] - places[p, 1], points[i, 2] - places[p, 2]
            a = r00 * u + r10 * v + r20 * t - centre[0]
            b = r01 * u + r11 * v + r21 * t - centre[1]
            c = r02 * u + r12 * v + r22 * t - centre[2]
            along, across = cosine * a + sine * b, cosine * b - sine * a
            if abs(along) <= half[0] and abs(across) <= half[1] and abs(c) <= half[2]:
                count += 1
        found[p] = count / max(len(points), 1)
    return found


@njit(cache=True, nogil=True)
def mean_of(  # type: ignore[no-untyped-def]
    depth, shade, earlier, colours, turn, shift, tolerance, noise, least_colour, total, tint, weight
):
    """Add what an earlier frame shows of the points of a frame to sums of depths (r, c) and colours (r, c, 3).

    ``turn`` (3, 3) and ``shift`` (3,) take homogeneous pixel coordinates from the frame to the ``earlier`` one. Depths
    between the pixels of one surface are interpolated. ``weight`` (r, c) counts the measurements.
    """
    rows, columns = depth.shape
    square = least_colour * least_colour
    for i in range(rows):
        for j in range(columns):
            z = depth[i, j]
            if z <= 0:
                continue
            ahead = (turn[2, 0] * j + turn[2, 1] * i + turn[2, 2]) * z + shift[2]
            if ahead <= 0:
                continue
            x = ((turn[0, 0] * j + turn[0, 1] * i + turn[0, 2]) * z + shift[0]) / ahead
            y = ((turn[1, 0] * j + turn[1, 1] * i + turn[1, 2]) * z + shift[1]) / ahead
            m, n = int(np.floor(y + 0.5)), int(np.floor(x + 0.5))
            if m < 0 or n < 0 or m >= rows or n >= columns or earlier[m, n] <= 0:
                continue
            near = max(tolerance, noise * z * z)
            apart = 0.0
            for k in range(3):
                apart += (float(shade[i, j, k]) - float(colours[m, n, k])) ** 2
            if abs(earlier[m, n] - ahead) > near or apart > square:
                continue
            down, across = y - m, x - n
            found = float(earlier[m, n])
            for p, q, share in (
                (m, n + (1 if across > 0 else -1), abs(across)),
                (m + (1 if down > 0 else -1), n, abs(down)),
            ):
                inside = share > 1e-3 and 0 <= p < rows and 0 <= q < columns
                if inside and earlier[p, q] > 0 and abs(earlier[p, q] - earlier[m, n]) < near:
                    found += share * (earlier[p, q] - earlier[m, n])
            total[i, j] += z + found - ahead
            weight[i, j] += 1.0
            for k in range(3):
                tint[i, j, k] += colours[m, n, k]
