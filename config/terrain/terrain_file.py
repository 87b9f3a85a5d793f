"""Elevations as a GeoTIFF of whole numbers, written and read. Needs gdal_translate and gdalbuildvrt (package gdal-bin)."""

import pathlib
import subprocess
import tempfile

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent


def write(name, pixel, unit, bands):
    """@param pixel of square shape [m]; unit: what is stored are whole multiples of it [m]; bands: name → elevations [m], south first"""
    with tempfile.TemporaryDirectory() as folder:
        files = []
        for band, elevation in bands.items():
            rows, columns = elevation.shape
            files.append(pathlib.Path(folder, band + ".asc"))
            header = f"ncols {columns}\nnrows {rows}\nxllcorner 0\nyllcorner 0\ncellsize {pixel}\n"
            lines = (" ".join(map(str, line)) for line in np.rint(elevation[::-1] / unit).astype(int))
            files[-1].write_text(header + "\n".join(lines) + "\n", encoding="ascii")
        stack = pathlib.Path(folder, "stack.vrt")
        subprocess.run(["gdalbuildvrt", "-q", "-separate", stack, *files], check=True)
        described = stack.read_text(encoding="utf-8")
        for number, band in enumerate(bands, start=1):
            described = described.replace(f'band="{number}">', f'band="{number}"><Description>{band}</Description>')
        stack.write_text(described, encoding="utf-8")
        subprocess.run(["gdal_translate", "-q", "-ot", "Int16", "-a_scale", str(unit), "-a_offset", "0", "-co", "COMPRESS=DEFLATE",
                        "-co", "PREDICTOR=2", "-co", "ZLEVEL=9", "-co", "INTERLEAVE=BAND", stack, HERE / name], check=True)


def read(name, band):
    """@return elevations that `write` wrote [m], south first. @param band its number, from 1"""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "band.asc")
        subprocess.run(["gdal_translate", "-q", "-of", "AAIGrid", "-b", str(band), "-unscale", "-ot", "Float64", HERE / name, file], check=True)
        return np.loadtxt(file, skiprows=5)[::-1]
