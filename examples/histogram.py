"""Histogram of the frequency shifts on one scan line of a dataset, with OpenImageIO's Python alone (Debian: python3-openimageio).
Usage: python3 histogram.py DATA.exr X,Y    prints shift and t of the crossings of pixel X,Y, then the histogram of line Y"""
import sys
import OpenImageIO as oiio

path, (x, y) = sys.argv[1], map(int, sys.argv[2].split(","))
file = oiio.ImageInput.open(path)
file.seek_subimage(1, 0)  # the deep part "hits"
names = list(file.spec().channelnames)
line = file.read_native_deep_scanlines(1, 0, y, y + 1, 0, 0, len(names))
value = lambda pixel, name, k: line.deep_value(pixel, names.index(name), k)
for k in range(line.samples(x)):
    print(f"shift {value(x, 'shift', k)!r}  t {value(x, 't', k)!r}")
shifts = [value(pixel, "shift", k) for pixel in range(line.pixels) for k in range(line.samples(pixel))]
for tenth in range(int(10 * max(shifts, default=0)) + 1):
    if count := sum(int(10 * g) == tenth for g in shifts):
        print(f"{tenth / 10:.1f} to {tenth / 10 + 0.1:.1f}  {'#' * (-(-60 * count // len(shifts)))} {count}")
