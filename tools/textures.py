"""Procedural textures that several worlds share: pictures from a random generator, nothing else."""
import math

import numpy as np
from PIL import Image, ImageDraw


def noise(rng, size, scales, weights):
    """Tileable value noise: sums of blurred random fields, 0 ... 1."""
    field = np.zeros((size, size))
    for scale, weight in zip(scales, weights):
        coarse = rng.random((size // scale, size // scale))
        tiled = np.tile(coarse, (3, 3))
        image = Image.fromarray((tiled * 255).astype(np.uint8)).resize((3 * size, 3 * size), Image.BICUBIC)
        field += weight * np.asarray(image)[size:2 * size, size:2 * size] / 255.0
    return field / sum(weights)


def stretched_noise(rng, size, scales, weights, stretch):
    """Noise drawn out along y, as water draws stains."""
    image = Image.fromarray((noise(rng, size, scales, weights) * 255).astype(np.uint8))
    tall = image.resize((size, size * stretch), Image.BICUBIC).crop((0, 0, size, size))
    return np.asarray(tall) / 255.0


def shade(field, low, high):
    low, high = np.array(low, float), np.array(high, float)
    return Image.fromarray((low + field[..., None] * (high - low)).clip(0, 255).astype(np.uint8))


def colours(image, count=96):
    return image.convert('RGB').quantize(count, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.FLOYDSTEINBERG)


def slabs(rng, size, count, light, dark, joint):
    image = Image.new('RGB', (size, size), joint)
    draw = ImageDraw.Draw(image)
    step = size / count
    for row in range(count):
        for column in range(count):
            mix = rng.random()
            colour = tuple(int(a + mix * (b - a)) for a, b in zip(dark, light))
            x, y = column * step, row * step
            draw.rectangle((x + 2, y + 2, x + step - 2, y + step - 2), fill=colour)
    grain = noise(rng, size, (2, 4, 32), (1, 1, 1))[..., None]
    return Image.fromarray((np.asarray(image) * (0.85 + 0.3 * grain)).clip(0, 255).astype(np.uint8))


def asphalt(rng, size):
    field = noise(rng, size, (1, 2, 64), (1.2, 1, 0.8))
    image = np.asarray(shade(field, (44, 45, 48), (104, 104, 106))).copy()
    draw = Image.fromarray(image)
    pen = ImageDraw.Draw(draw)
    for _ in range(5):  # cracks
        x, y = rng.random(2) * size
        points = [(x, y)]
        for _ in range(14):
            x, y = x + rng.normal(0, 14), y + rng.normal(6, 10)
            points.append((x, y))
        pen.line(points, fill=(38, 38, 40), width=2)
    return draw


def window(rng, size):
    """A window with its frame, curtain and a reflection of the sky."""
    image = Image.new('RGB', (size, size), (236, 234, 228))
    draw = ImageDraw.Draw(image)
    edge = size // 12
    for y in range(edge, size - edge):
        s = (y - edge) / (size - 2 * edge)
        draw.line((edge, y, size - edge, y), fill=(int(96 - 58 * s), int(124 - 72 * s), int(150 - 78 * s)))
    for side in (0, 1):
        x0 = edge if side == 0 else size - edge - size // 6
        for i in range(size // 6):
            tone = int(205 + 25 * math.sin(i * 0.9))
            draw.line((x0 + i, edge, x0 + i, int(size * 0.86)), fill=(tone, tone - 4, tone - 14))
    mid = size // 2
    draw.rectangle((mid - 3, 0, mid + 3, size), fill=(236, 234, 228))
    draw.rectangle((0, int(size * 0.33) - 3, size, int(size * 0.33) + 3), fill=(236, 234, 228))
    return image


def door(size, colour):
    image = Image.new('RGB', (size, size), colour)
    draw = ImageDraw.Draw(image)
    dark = tuple(int(c * 0.7) for c in colour)
    for x in (0.14, 0.56):
        for y0, y1 in ((0.08, 0.42), (0.5, 0.92)):
            draw.rectangle((x * size, y0 * size, (x + 0.3) * size, y1 * size), outline=dark, width=size // 40)
    draw.ellipse((0.88 * size, 0.47 * size, 0.93 * size, 0.52 * size), fill=(212, 190, 120))
    return image


def sky(rng, size):
    """Six faces above one another: right, left, up, down, front, back."""
    top, horizon = np.array((86, 138, 206.0)), np.array((206, 222, 236.0))
    faces = []
    height = np.linspace(1, -1, size)[:, None]
    for face in range(6):
        if face == 2:
            image = np.tile(top, (size, size, 1))
            cloud = noise(rng, size, (32, 64, 128), (1, 2, 2))
            image += ((cloud - 0.56).clip(0, 1) * 3.0)[..., None].clip(0, 1) * (np.array((250, 250, 252)) - image)
        elif face == 3:
            image = np.tile(np.array((110, 116, 112.0)), (size, size, 1))
        else:
            mix = np.clip(height * 1.3, 0, 1) ** 0.6
            image = horizon + np.repeat(mix, size, 1)[..., None] * (top - horizon)
            image[height[:, 0] < 0] = (150, 158, 156)
            cloud = noise(rng, size, (32, 64, 128), (1, 2, 2))
            veil = ((cloud - 0.53) * 4).clip(0, 1) * np.clip(height * 3, 0, 1) * np.clip(1.6 - height * 1.4, 0, 1)
            image += veil[..., None] * (np.array((252, 252, 252)) - image)
        faces.append(image)
    return Image.fromarray(np.concatenate(faces).clip(0, 255).astype(np.uint8))


def stripes(size, light, dark):
    a, b = np.meshgrid(np.arange(size), np.arange(size))
    is_light = ((a + b) // (size // 4)) % 2 == 0
    return Image.fromarray(np.where(is_light[..., None], light, dark).astype(np.uint8))


def tread_plate(size):
    """Chequered steel."""
    image = Image.new('RGB', (size, size), (104, 106, 108))
    draw = ImageDraw.Draw(image)
    step = size // 8
    for i in range(9):
        for j in range(9):
            x, y = i * step, j * step
            dx, dy = (step // 3, step // 8) if (i + j) % 2 else (step // 8, step // 3)
            draw.ellipse((x - dx, y - dy, x + dx, y + dy), fill=(150, 152, 154))
    return image


def sign(text, background, ink, size=(256, 128)):
    """Letters of the built-in font, enlarged."""
    letters = Image.new('L', (6 * len(text) + 2, 12), 0)
    ImageDraw.Draw(letters).text((1, 0), text, fill=255)
    letters = letters.crop(letters.getbbox())
    scale = min((size[0] - 40) / letters.width, (size[1] - 40) / letters.height)
    letters = letters.resize((int(letters.width * scale), int(letters.height * scale)), Image.BICUBIC)
    image = Image.new('RGB', size, background)
    ImageDraw.Draw(image).rectangle((5, 5, size[0] - 6, size[1] - 6), outline=ink, width=4)
    image.paste(ink, ((size[0] - letters.width) // 2, (size[1] - letters.height) // 2), letters)
    return image
