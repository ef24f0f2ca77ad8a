#!/usr/bin/env python3
"""Tests luminaire against Mitsuba 3 (https://mitsuba-renderer.org): the same scene in both, several pictures of different seeds from each.

  pip install mitsuba scipy
  for s in $(seq 16); do luminaire render scene.toml --spp 128 --seed $s -o ours-$s.exr; done
  compare-mitsuba.py render scene.xml theirs --seeds 16 --spp 128      writes theirs-1.npy, theirs-2.npy, ...
  compare-mitsuba.py test --ours ours-*.exr --theirs theirs-*.npy      exit code 1 if they differ
  compare-mitsuba.py race scene.toml scene.xml reference.npy           error times time of both, in turn

The scatter over the seeds says how well each mean is known, so that no tolerance has to be chosen: the picture falls into blocks, and Welch's t-test
says for each block and channel how often two right renderers would be as far apart. Then three questions are asked of all blocks together:

  furthest   is the one block and channel that is furthest off further than chance explains (Sidak's correction for their number)?
  sum        is the sum of z^2 over the blocks, which many small differences raise, larger than chance explains (chi-square)?
  shape      are the z distributed as a normal distribution has it (Kolmogorov and Smirnov)?

The last two are asked of each channel by itself, because the channels of a picture share their paths and are not independent; the least of the three
p is corrected for being that (Sidak). So is the least of the three answers: below 1e-4 the renderers differ. z is the normal deviate of the same p as
Welch's t.

Take 16 seeds or more on each side: with fewer, a block none of whose seeds has met its rare bright paths looks surer than it is. The camera, the
pixel filter (Mitsuba: <rfilter type="box"/>), the number of bounces (max_depth -1) and which sides of a lamp shine (Mitsuba: one; luminaire:
`one_sided = true`) have to be the same in both scenes.

A race renders in turn, several times, each time with another seed. What counts is relMSE (the mean of (a - b)^2 / (b^2 + (m/3)^2) over pixels and
channels, m the half-power mean of the reference b) times the seconds for rendering alone: half of it is twice as fast. Loading, building and the first use of a kernel are left out on both sides; Mitsuba's
seconds have what its Python does for a render, and the reference's own error is in both errors.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import mitsuba
import numpy as np

try:
    from scipy import stats
except ImportError:  # a race goes without
    stats = None

SIGNIFICANCE = 1e-4
# Relative difference of two means that rounding in single precision may explain.
ROUNDING = 2e-6


def load(path):
    """The linear RGB of an .npy or .exr file, as an array [row, column, channel]."""
    if path.suffix == ".npy":
        picture = np.load(path)
    else:
        # An EXR file of luminaire has its standard errors in a layer beside the picture, which has no name.
        layers = dict(mitsuba.Bitmap(str(path)).split())
        picture = np.array(layers["<root>"])
    if picture.ndim != 3 or picture.shape[2] < 3 or not np.isfinite(picture[..., :3]).all():
        sys.exit(f"{path}: expected a picture of three channels, all finite, found shape {picture.shape}")
    return picture[..., :3].astype(float)


def block_means(paths, size):
    """Means over blocks of size x size pixels: an array [picture, row, column, channel]."""
    pictures = [load(p) for p in paths]
    shapes = {p.shape for p in pictures}
    if len(shapes) != 1 or len(pictures) < 2:
        sys.exit(f"expected at least two pictures of one size, found {len(pictures)} of the sizes {sorted(shapes)}")
    height, width, _ = shapes.pop()
    if height % size or width % size:
        sys.exit(f"blocks of {size} pixels do not fill {width} x {height}: choose another --block")
    return np.array([p.reshape(height // size, size, width // size, size, 3).mean(axis=(1, 3)) for p in pictures])


def deviates(ours, theirs):
    """Welch's t-test of arrays [picture, ...] of means: normal deviates z, NaN where neither side varies and both are equal."""
    difference = ours.mean(0) - theirs.mean(0)
    excess = np.sign(difference) * np.maximum(np.abs(difference) - ROUNDING * np.abs(theirs.mean(0)), 0)
    variances = [x.var(0, ddof=1) / len(x) for x in (ours, theirs)]
    variance = sum(variances)
    with np.errstate(divide="ignore", invalid="ignore"):
        t = excess / np.sqrt(variance)
        freedom = variance**2 / sum(v**2 / (len(x) - 1) for v, x in zip(variances, (ours, theirs)))
    # Without any variance t is infinite or, for equal means, not a number.
    p = np.where(np.isinf(t), 0.0, 2 * stats.t.sf(np.abs(t), freedom))
    return np.sign(t) * stats.norm.isf(p / 2)


def sidak(p, number):
    """The probability that the least of `number` independent p is p or less."""
    return -np.expm1(number * np.log1p(-p)) if p < 1 else 1.0


def whole(ours, theirs):
    """Ratios of the means of whole pictures and their standard errors, by channel."""
    a, b = (x.mean(axis=(1, 2)) for x in (ours, theirs))
    ratio = a.mean(0) / b.mean(0)
    relative = [(x.std(0, ddof=1) / np.sqrt(len(x)) / x.mean(0)) ** 2 for x in (a, b)]
    return ratio, ratio * np.sqrt(sum(relative))


def judge(ours, theirs):
    """Prints the tests of two arrays of block means; the p of the whole."""
    ratio, error = whole(ours, theirs)
    print("mean over mean       " + "  ".join(f"{c} {r:.5f} +- {e:.5f}" for c, r, e in zip("RGB", ratio, error)))
    size = np.sqrt(ours.var(0, ddof=1) / len(ours) + theirs.var(0, ddof=1) / len(theirs))
    bright = theirs.mean(0) > 0
    print(f"error of a block     {np.median(size[bright] / theirs.mean(0)[bright]):.2%} of its mean (the median block and channel)")
    z = deviates(ours, theirs)
    number = int(np.isfinite(z).sum() + np.isinf(z).sum())
    flat = np.nan_to_num(np.abs(z), nan=0.0, posinf=np.inf)
    row, column, channel = np.unravel_index(np.argmax(flat), z.shape)
    furthest = sidak(2 * stats.norm.sf(flat.max()), number)
    print(f"tests                {number}")
    print(f"furthest             z = {z[row, column, channel]:+.2f} in {'RGB'[channel]} of block column {column}, row {row} from the top")
    sums, shapes = [], []
    for c in range(3):
        of_channel = z[..., c][~np.isnan(z[..., c])]
        sums.append(stats.chi2.sf((of_channel**2).sum(), len(of_channel)))
        shapes.append(stats.kstest(of_channel, "norm").pvalue)
        print(f"{'RGB'[c]}: mean z^2          {(of_channel**2).mean():.3f}   sum p = {sums[-1]:.3g}   shape p = {shapes[-1]:.3g}")
    answers = {"furthest": furthest, "sum": sidak(min(sums), 3), "shape": sidak(min(shapes), 3)}
    print("p                    " + "  ".join(f"{name} {p:.3g}" for name, p in answers.items()))
    edges = [-np.inf, -3, -2, -1, 0, 1, 2, 3, np.inf]
    found, _ = np.histogram(z[~np.isnan(z)], edges)
    expected = number * np.diff(stats.norm.cdf(edges))
    print("z from  to     found  expected")
    for low, high, f, e in zip(edges, edges[1:], found, expected):
        print(f"{low:6} {high:5} {f:7} {e:9.1f}")
    return sidak(min(answers.values()), len(answers))


def render(arguments):
    """Renders a Mitsuba scene with the seeds 1, 2, ..."""
    mitsuba.set_variant(arguments.variant)
    scene = mitsuba.load_file(str(arguments.scene))
    for seed in range(1, arguments.seeds + 1):
        picture = np.array(mitsuba.render(scene, spp=arguments.spp, seed=seed), dtype=np.float32)
        np.save(f"{arguments.output}-{seed}.npy", picture)


def test(arguments):
    """Compares two sets of pictures."""
    if stats is None:
        sys.exit("scipy is missing: pip install scipy")
    # For its reader of EXR files.
    mitsuba.set_variant("scalar_rgb")
    ours, theirs = (block_means(paths, arguments.block) for paths in (arguments.ours, arguments.theirs))
    if ours.shape[1:] != theirs.shape[1:]:
        sys.exit(f"the pictures differ in size: {ours.shape[1:3]} and {theirs.shape[1:3]} blocks")
    p = judge(ours, theirs)
    print(f"they {'differ' if p < SIGNIFICANCE else 'do not differ'} (p = {p:.3g}; they do below {SIGNIFICANCE})")
    return 1 if p < SIGNIFICANCE else 0


def rel_mse(picture, reference):
    half_power_mean = np.sqrt(np.maximum(reference, 0)).mean() ** 2
    return float(((picture - reference) ** 2 / (reference**2 + (half_power_mean / 3) ** 2)).mean())


def race(arguments):
    """Renders in turn and prints relMSE times seconds of both, and the ratios."""
    mitsuba.set_variant(arguments.variant)
    import drjit  # known only after a variant is set

    reference = load(arguments.reference)
    height, width = reference.shape[:2]
    folder = tempfile.TemporaryDirectory()
    picture, figures = Path(folder.name, "ours.exr"), Path(folder.name, "ours.json")
    theirs = mitsuba.load_file(str(arguments.theirs))

    def ours_run(seed, spp):
        command = [arguments.luminaire, "render", str(arguments.ours), "--spp", str(spp), "--seed", str(seed), "--width", str(width),
                   "--height", str(height), "-o", str(picture), "--stats", str(figures), "--quiet", *arguments.option]  # fmt: skip
        subprocess.run(command, check=True)
        stats = json.loads(figures.read_text())
        return load(picture), stats["seconds"]["render"], stats["rays"] / stats["seconds"]["render"] * 1e-6

    def theirs_run(seed, spp):
        start = time.perf_counter()
        image = mitsuba.render(theirs, spp=spp, seed=seed)
        drjit.eval(image)
        drjit.sync_thread()
        seconds = time.perf_counter() - start
        return np.array(image)[..., :3].astype(float), seconds

    # Compiles kernels on both sides.
    ours_run(0, arguments.spp), theirs_run(0, arguments.spp)
    print(f"{width} x {height}, {arguments.spp} samples a pixel; luminaire {' '.join(arguments.option)}, Mitsuba {mitsuba.__version__} {arguments.variant}")
    print("round   ours: relMSE  seconds  product  Mrays/s    theirs: relMSE  seconds  product    theirs / ours")
    products = []
    # Not the seeds that `render` takes: a reference made of those would be no reference.
    for seed in range(1001, 1001 + arguments.rounds):
        image, seconds, rate = ours_run(seed, arguments.spp)
        their_image, their_seconds = theirs_run(seed, arguments.spp)
        ours, their = rel_mse(image, reference), rel_mse(their_image, reference)
        products.append((ours * seconds, their * their_seconds))
        a, b = products[-1]
        print(f"{seed:5}   {ours:12.6f} {seconds:8.3f} {a:8.5f} {rate:8.2f}    {their:14.6f} {their_seconds:8.3f} {b:8.5f} {b / a:16.2f}")
    a, b = (np.array(side) for side in zip(*products))
    ratios = b / a
    for name, values in [("ours", a), ("theirs", b), ("theirs / ours", ratios)]:
        print(f"{name:14} median {np.median(values):.5f}   {values.min():.5f} to {values.max():.5f}")
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    command = commands.add_parser("render", help="pictures by Mitsuba, one of each seed")
    command.add_argument("scene", type=Path, help="a Mitsuba scene (.xml)")
    command.add_argument("output", help="the pictures are OUTPUT-1.npy, OUTPUT-2.npy, ...")
    command.add_argument("--seeds", type=int, default=16)
    command.add_argument("--spp", type=int, default=128)
    command.add_argument("--variant", default="scalar_rgb", help="of Mitsuba; llvm_ad_rgb is faster and wants LLVM")
    command.set_defaults(run=render)
    command = commands.add_parser("test", help="compare two sets of pictures")
    command.add_argument("--ours", nargs="+", type=Path, required=True, help=".exr or .npy files, one of each seed")
    command.add_argument("--theirs", nargs="+", type=Path, required=True, help="the same of the other renderer")
    command.add_argument("--block", type=int, default=16, help="side of a block in pixels (default 16)")
    command.set_defaults(run=test)
    command = commands.add_parser("race", help="error times time of both, in turn")
    command.add_argument("ours", type=Path, help="luminaire's scene")
    command.add_argument("theirs", type=Path, help="the same for Mitsuba (.xml)")
    command.add_argument("reference", type=Path, help="what it really looks like (.npy or .exr)")
    command.add_argument("--rounds", type=int, default=5)
    command.add_argument("--spp", type=int, default=64, help="samples a pixel, on both sides")
    command.add_argument("--variant", default="llvm_ad_rgb", help="of Mitsuba: llvm_ad_rgb, cuda_ad_rgb, scalar_rgb")
    command.add_argument("--luminaire", default="target/release/luminaire", help="the program")
    command.add_argument("--option", action="append", default=[], help="for luminaire, such as --option=--backend=ray-query")
    command.set_defaults(run=race)
    arguments = parser.parse_args()
    try:
        sys.exit(arguments.run(arguments))
    except (OSError, RuntimeError, ValueError) as error:
        sys.exit(f"{parser.prog}: {error}")


if __name__ == "__main__":
    main()
