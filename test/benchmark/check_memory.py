#!/usr/bin/env python3
"""Asserts that sand_run, with all that it writes, takes at most 2 GiB for a scene: check_memory.py SAND_RUN SCENE"""
import os
import resource
import subprocess
import sys
import tempfile

LIMIT = 2 << 30  # bytes

sand_run, scene = sys.argv[1:]
with tempfile.TemporaryDirectory() as folder:
    outputs = [argument for option, name in (('--save', 'state.tif'), ('--picture', 'picture.png'), ('--report', 'report.json'))
               for argument in (option, os.path.join(folder, name))]
    subprocess.run([sand_run, scene, '--backend', 'cpu', *outputs], check=True)
most = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024
print(f'{most / (1 << 30):.2f} GiB of at most {LIMIT / (1 << 30):g}')
sys.exit(0 if most <= LIMIT else 1)
