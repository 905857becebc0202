"""Figures of pictures, as exr.read() returns them: means, errors, how far two converged ones are apart."""

BLOCK = 32  # Pixels.


def means(picture):
    """Means of the channels R, G and B."""
    _, _, planes = picture
    return [sum(plane) / len(plane) for plane in planes]


def relmse(picture, reference):
    """Mean over pixels and channels of (x - r)^2 / (r^2 + m^2 / 100), where r is the reference's value, and m the mean
    of all of them."""
    epsilon = 0.01 * (sum(means(reference)) / 3) ** 2
    planes, references = picture[2], reference[2]
    total = sum((x - r) ** 2 / (r * r + epsilon) for p, q in zip(planes, references) for x, r in zip(p, q))
    return total / sum(len(plane) for plane in planes)


def block_means(picture):
    """Means of blocks of BLOCK x BLOCK pixels over all channels together, row by row."""
    width, height, planes = picture
    columns = -(-width // BLOCK)
    sums, counts = ([0] * (columns * -(-height // BLOCK)) for _ in range(2))
    for plane in planes:
        for row in range(height):
            first = row // BLOCK * columns
            for column in range(columns):
                part = plane[row * width + column * BLOCK : min((row + 1) * width, row * width + (column + 1) * BLOCK)]
                sums[first + column] += sum(part)
                counts[first + column] += len(part)
    return [total / count for total, count in zip(sums, counts)]


def differences(picture, other):
    """The relative difference of the means, of all pixels and, as root mean square, of blocks."""
    blocks = [a / b - 1 for a, b in zip(block_means(picture), block_means(other)) if b > 0]
    whole = sum(means(picture)) / sum(means(other)) - 1
    return whole, (sum(d * d for d in blocks) / len(blocks)) ** 0.5
