#!/usr/bin/env python3
"""Checks what the compiler made of the kernels: the machine code and the PTX in a library.

check_resources.py LIBRARY            exit 1 and one line for each finding
check_resources.py --table LIBRARY    tells what every kernel takes on every architecture
check_resources.py --self-check NVCC  compiles kernels with planted defects and expects that they are found

stack      No function has a stack frame, and none reads or writes local memory (LDL, STL), which is where spilled registers
           and arrays indexed at run time go. A function whose stack the compiler cannot bound is a finding, too.
registers  No function takes more registers a thread than its budget (REGISTERS).
rounding   In PTX every addition, subtraction, multiplication, division and root of floats says .rn, and nothing is fused,
           approximate, flushed to zero or added in the order in which threads come. Of PTX with .rn ptxas must not make
           fused operations; of PTX without any it may.
fused      In machine code the fused operations (FFMA, DFMA) are no more than divisions, reciprocals and roots are made of.

What the last cannot prove: it counts. The sequences of ptxas are known by their marks (FCHK, MUFU), and their slow paths are
functions of NVIDIA's, left out. For floats the sequences have a fixed length: where the table tells as many found as
explained, one that is left over could only stand for one that ptxas spared. For doubles, and where fewer are found than
explained, the count is no more than a bound. Code for architectures other than sm_70 to sm_90 has other numbers for its
instructions, and is a finding.
"""

import argparse
import collections
import re
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

# The first that fits the mangled name counts (Lb0E is false, Lb1E true: with bodies, with minmod). A multiprocessor has
# 65536 registers, a block 128 threads: with 128 registers a thread four blocks are there at once, with 168 three, with 255
# two, and one computes while the others wait for memory. With bodies a run of steps holds everything that they do to sand.
REGISTERS = [(re.compile("takeStepsOnGpuILb0ELb0E"), 128),
             (re.compile("takeStepsOnGpuILb0ELb1E"), 168),
             (re.compile("takeStepsOnGpuILb1E"), 255),
             (re.compile("claimCells|settleGrains"), 96),
             (re.compile(""), 80)]

Image = collections.namedtuple("Image", "architecture machine_code content")
Usage = collections.namedtuple("Usage", "registers stack spills fused explained fused_doubles explained_doubles")
Finding = collections.namedtuple("Finding", "kernel rule architecture text")


# Kinds of sections and of symbols in ELF.
SYMBOLS, NOTHING_IN_FILE = 2, 8
FUNCTION_SYMBOL = 2
Symbol = collections.namedtuple("Symbol", "name is_function section begin end")


class Unreadable(Exception):
    """A file that cannot be checked."""


class Elf:
    """Sections and symbols of a 64-bit ELF file."""

    def __init__(self, content):
        self.content = content
        start, = struct.unpack_from("<Q", content, 40)
        count, names = struct.unpack_from("<HH", content, 60)
        headers = [struct.unpack_from("<IIQQQQIIQQ", content, start + 64 * i) for i in range(count)]
        self.sections = [(self.text(headers[names][4] + name), b"" if kind == NOTHING_IN_FILE else content[begin:begin + size])
                         for name, kind, _, _, begin, size, *_ in headers]
        self.symbols = []
        for _, kind, _, _, begin, size, strings, *_ in headers:
            if kind == SYMBOLS:
                for offset in range(begin, begin + size, 24):
                    name, information, _, section, value, length = struct.unpack_from("<IBBHQQ", content, offset)
                    self.symbols.append(Symbol(self.text(headers[strings][4] + name), information & 15 == FUNCTION_SYMBOL,
                                               section, value, value + length))

    def text(self, offset):
        return self.content[offset:self.content.index(b"\0", offset)].decode()

    def section(self, name):
        return next((content for other, content in self.sections if other == name), None)


def images(content):
    """What a library, an object file or a fat binary holds for each architecture."""
    if content[:4] == b"\x7fELF":
        content = Elf(content).section(".nv_fatbin")
        if content is None:
            raise Unreadable("there are no kernels in it")
    offset = 0
    while offset + 16 <= len(content):
        magic, _, header, size = struct.unpack_from("<IHHQ", content, offset)
        if magic != 0xBA55ED50:
            offset += 8
            continue
        entry, end = offset + header, offset + header + size
        while entry < end:
            kind, _, header, size = struct.unpack_from("<HHIQ", content, entry)
            architecture, = struct.unpack_from("<I", content, entry + 28)
            flags, = struct.unpack_from("<Q", content, entry + 40)
            if flags & 0xA000:
                raise Unreadable("its kernels are compressed; compile with nvcc --no-compress")
            yield Image(architecture, kind == 2, content[entry + header:entry + header + size])
            entry += header + size
        offset = end


# Of an instruction of 16 bytes the lowest 9 bits say what it does, the next 3 where its operands are.
FFMA, DFMA, MUFU, FCHK, STL, LDL, I2F = 0x023, 0x02B, 0x108, 0x102, 0x187, 0x183, 0x106
IMMEDIATE = 4
MUFU_FUNCTIONS = {4: "reciprocal", 5: "root", 6: "reciprocal of a double", 7: "root of a double"}
TOWARDS_INFINITY = 2


def instruction_counts(code, left_out):
    counts = collections.Counter()
    for offset in range(0, len(code) - 15, 16):
        if any(begin <= offset < end for begin, end in left_out):
            continue
        low, high = struct.unpack_from("<QQ", code, offset)
        operation = low & 0x1FF
        counts[operation] += 1
        if operation == MUFU:
            counts[MUFU_FUNCTIONS.get(high >> 10 & 15)] += 1
        elif operation == FCHK and low >> 9 & 7 == IMMEDIATE:
            counts["division by a constant"] += 1
        elif operation == I2F and high >> 14 & 3 == TOWARDS_INFINITY:
            counts["division of integers"] += 1
    return counts


def explained_by_sequences(counts):
    """How many operations of floats and of doubles are fused in divisions, reciprocals and roots.

    A reciprocal of floats fuses 2; a division is one and 3 more, and has the 2 even if its reciprocal is a constant; a root
    fuses 2. Integers are divided by a reciprocal without any. For doubles the longest sequences are counted.
    """
    floats = (2 * (counts["reciprocal"] - counts["division of integers"]) + 3 * counts[FCHK] +
              2 * counts["division by a constant"] + 2 * counts["root"] + counts["reciprocal of a double"])
    doubles = 7 * counts["reciprocal of a double"] + 5 * counts["root of a double"]
    return floats, doubles


# Attributes of functions in .nv.info, whose values are a symbol's number and a count.
REGISTER_COUNT, FRAME_SIZE, STACK_SIZE = 0x2F, 0x11, 0x12
VALUE_FOLLOWS = 4
SLOW_PATH = re.compile(r"\$__internal_\d+_\$__cuda_sm")


def function_attributes(elf):
    attributes = collections.defaultdict(dict)
    content = elf.section(".nv.info")
    offset = 0
    while content and offset < len(content):
        form, attribute, size = struct.unpack_from("<BBH", content, offset)
        offset += 4
        if form == VALUE_FOLLOWS:
            if attribute in (REGISTER_COUNT, FRAME_SIZE, STACK_SIZE):
                symbol, value = struct.unpack_from("<Ii", content, offset)
                attributes[elf.symbols[symbol].name][attribute] = value
            offset += size
    return attributes


def usages(image):
    """What each function of a machine code takes."""
    elf = Elf(image.content)
    attributes = function_attributes(elf)
    found = {}
    for number, (section, code) in enumerate(elf.sections):
        if not section.startswith(".text."):
            continue
        name = section[len(".text."):]
        slow_paths = [(symbol.begin, symbol.end) for symbol in elf.symbols
                      if symbol.section == number and symbol.is_function and SLOW_PATH.match(symbol.name)]
        counts = instruction_counts(code, slow_paths)
        own = attributes.get(name, {})
        if REGISTER_COUNT not in own or FRAME_SIZE not in own:
            raise Unreadable(f"sm_{image.architecture}: {name} does not say how many registers it takes, or how much stack")
        stack = -1 if own.get(STACK_SIZE, 0) < 0 else max(own[FRAME_SIZE], own.get(STACK_SIZE, 0))
        floats, doubles = explained_by_sequences(counts)
        found[name] = Usage(own[REGISTER_COUNT], stack, counts[STL] + counts[LDL], counts[FFMA], floats, counts[DFMA], doubles)
    return found


def budget_of(kernel):
    return next(budget for name, budget in REGISTERS if name.search(kernel))


def usage_findings(kernel, architecture, usage):
    def finding(rule, text):
        return Finding(kernel, rule, f"sm_{architecture}", text)

    if usage.stack < 0:
        yield finding("stack", "a stack without bound")
    elif usage.stack > 0 or usage.spills > 0:
        yield finding("stack", f"{usage.stack} bytes of stack, {usage.spills} reads and writes of local memory")
    budget = budget_of(kernel)
    if usage.registers > budget:
        yield finding("registers", f"{usage.registers} registers a thread; at most {budget}")
    if usage.fused > usage.explained:
        yield finding("fused", f"{usage.fused} fused operations of floats; divisions and roots explain {usage.explained}")
    if usage.fused_doubles > usage.explained_doubles:
        yield finding("fused", f"{usage.fused_doubles} fused operations of doubles; divisions and roots explain "
                               f"{usage.explained_doubles}")


FUNCTION = re.compile(r"^\s*(?:\.visible\s+|\.weak\s+|\.extern\s+)*\.(?:entry|func)\s+(?:\([^)]*\)\s*)?([\w$]+)")
INSTRUCTION = re.compile(r"^\s*\{?\s*(?:@!?%\w+\s+)?([a-z]\w*)((?:\.[\w:]+)+)\s")
FLOATS = re.compile(r"b?f(16|32|64)(x2)?$|tf32$|e\dm\d\w*$")
EXACT = {"add", "sub", "mul", "div", "sqrt", "rcp"}


def rounding_problem(operation, modifiers):
    """What is wrong with an instruction of PTX; None if nothing is."""
    if not any(FLOATS.match(modifier) for modifier in modifiers):
        return None
    if operation in ("fma", "mad"):
        return "is fused"
    if "approx" in modifiers or "full" in modifiers:
        return "is approximate"
    if "ftz" in modifiers:
        return "flushes small numbers to zero"
    if operation in EXACT and "rn" not in modifiers:
        return "does not say .rn, so that it may be fused"
    if operation in ("atom", "red") and "add" in modifiers:
        return "adds in the order in which threads come"
    return None


def rounding_findings(image):
    function = ""
    counts = collections.Counter()
    for line in image.content.decode("ascii", "replace").split("\n"):
        named = FUNCTION.match(line)
        if named:
            function = named.group(1)
            continue
        instruction = INSTRUCTION.match(line)
        if instruction:
            operation, modifiers = instruction.group(1), instruction.group(2)
            problem = rounding_problem(operation, modifiers[1:].split("."))
            if problem:
                counts[function, f"{operation}{modifiers} {problem}"] += 1
    return [Finding(function, "rounding", f"compute_{image.architecture}", f"{count} times {text}")
            for (function, text), count in counts.items()]


def check(content):
    """What all functions take, as a map from architectures to maps from names, and all findings."""
    taken = {}
    found = []
    portable = False
    for image in images(content):
        if not image.machine_code:
            portable = True
            found += rounding_findings(image)
        elif not 70 <= image.architecture < 100:
            found.append(Finding("", "fused", f"sm_{image.architecture}", "the numbers of its instructions are not known here"))
        else:
            here = usages(image)
            taken.setdefault(image.architecture, {}).update(here)
            for name, usage in here.items():
                found += usage_findings(name, image.architecture, usage)
    if not portable:
        found.append(Finding("", "rounding", "PTX", "there is none, so that roundings cannot be checked"))
    return taken, found


def readable(names):
    """Kernels by the names that they have in the source, without arguments and our own namespace."""
    names = sorted(names)
    try:
        lines = subprocess.run(["c++filt"], input="\n".join(names), stdout=subprocess.PIPE, check=True,
                               universal_newlines=True).stdout.split("\n")
    except OSError:
        lines = names
    return {name: re.sub(r"^void |shallow_sand::|\((bool|int|unsigned int)\)", "", re.sub(r"\([^()]*\)( const)?$", "", line))
            for name, line in zip(names, lines)}


def print_findings(found):
    """One line for each kernel and rule; architectures that say the same are told together."""
    names = readable({finding.kernel for finding in found})
    together = collections.OrderedDict()
    for finding in found:
        architectures = together.setdefault((finding.kernel, finding.rule), collections.OrderedDict())
        architectures.setdefault(finding.text, []).append(finding.architecture)
    for (kernel, rule), texts in together.items():
        told = "; ".join(f"{', '.join(architectures)}: {text}" for text, architectures in texts.items())
        print(": ".join(part for part in (names[kernel], rule, told) if part))


def print_table(taken):
    architectures = sorted(taken)
    kernels = set().union(*taken.values())
    names = readable(kernels)
    print("registers on " + " ".join(f"sm_{architecture}" for architecture in architectures) +
          "; most stack [bytes]; most reads and writes of local memory; fused floats found/explained, doubles; kernel")
    for kernel in sorted(kernels, key=names.get):
        here = [taken[architecture].get(kernel) for architecture in architectures]
        there = [usage for usage in here if usage]
        fused = sorted({(usage.fused, usage.explained) for usage in there})
        doubles = sorted({(usage.fused_doubles, usage.explained_doubles) for usage in there})
        print(" ".join(f"{usage.registers:3d}" if usage else "  -" for usage in here),
              f"{max(usage.stack for usage in there):5d} {max(usage.spills for usage in there):4d}",
              " ".join(f"{found}/{explained}" for found, explained in fused).rjust(9),
              " ".join(f"{found}/{explained}" for found, explained in doubles).rjust(5), names[kernel])


PROBES = r"""
extern "C" {

__global__ void divisions(float* x, float* y, int* k, float d) {
  int i = threadIdx.x;
  x[i] = x[i] / y[i] + 1.0f / y[i + 1];
  y[i] = sqrtf(x[i + 1]) / 3.0f - y[i + 2] / d;
  k[i] = k[i] % k[i + 1] + k[i + 2] / k[i + 3];
}

__global__ void doubles(double* x) {
  int i = threadIdx.x;
  x[i] = x[i] / x[i + 1] + sqrt(x[i + 2]) - 1.0 / x[i + 3];
}

__global__ void integers(int* k) {
  int i = threadIdx.x;
  k[i] = k[i] * k[i + 1] + k[i + 2];
  atomicAdd(k + 99, i);
}

__global__ void products(float* x) {
  int i = threadIdx.x;
  x[i] = x[i] * x[i + 1] + x[i + 2];
}

__global__ void products_of_doubles(double* x) {
  int i = threadIdx.x;
  x[i] = x[i] * x[i + 1] + x[i + 2];
}

__global__ void fused_beside_a_division(float* x) {
  int i = threadIdx.x;
  x[i] = fmaf(x[i], x[i + 1], x[i + 2]) / x[i + 3];
}

__global__ void approximate(float* x) {
  int i = threadIdx.x;
  x[i] = __fdividef(x[i], x[i + 1]);
}

__global__ void order_of_threads(float* x) { atomicAdd(x, x[threadIdx.x]); }

__global__ void array(float* x, const int* k) {
  float a[32];
  for (int i = 0; i < 32; ++i) a[i] = x[k[i]];
  for (int i = 0; i < 32; ++i) x[i] = a[k[i] & 31];
}

__global__ void __launch_bounds__(1024) spilled(volatile float* x) {
  float a[100];
#pragma unroll
  for (int i = 0; i < 100; ++i) a[i] = x[i];
#pragma unroll
  for (int i = 0; i < 100; ++i) x[i] = a[99 - i];
}

__global__ void greedy(volatile float* x) {
  float a[150];
#pragma unroll
  for (int i = 0; i < 150; ++i) a[i] = x[i];
#pragma unroll
  for (int i = 0; i < 150; ++i) x[i] = a[149 - i];
}

__device__ __noinline__ int steps(int k) { return k < 2 ? k : steps(k - 1) + steps(k - 2) * k; }
__global__ void recursive(int* k) { *k = steps(*k); }
}
"""

# The rules that they break, compiled with --fmad=false; and with --fmad=true.
BROKEN = {
    "divisions": (set(), {"rounding"}),
    "doubles": (set(), {"rounding"}),
    "integers": (set(), set()),
    "products": (set(), {"fused", "rounding"}),
    "products_of_doubles": (set(), {"fused", "rounding"}),
    "fused_beside_a_division": ({"fused", "rounding"}, {"fused", "rounding"}),
    "approximate": ({"rounding"}, {"rounding"}),
    "order_of_threads": ({"rounding"}, {"rounding"}),
    "array": ({"stack"}, {"stack"}),
    "spilled": ({"stack"}, {"stack"}),
    "greedy": ({"registers"}, {"registers"}),
    "recursive": ({"stack"}, {"stack"}),
}


def compile_probes(nvcc, folder, *options):
    known = subprocess.run([nvcc, "--list-gpu-code"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False,
                           universal_newlines=True).stdout
    architectures = [number for number in (75, 80, 90) if not known or f"sm_{number}" in known]
    source = Path(folder, "probes.cu")
    source.write_text(PROBES, encoding="utf-8")
    result = Path(folder, "probes.fatbin")
    subprocess.run([nvcc, "-fatbin", "-o", str(result), str(source), *options] +
                   [f"-gencode=arch=compute_{number},code=sm_{number}" for number in architectures] +
                   [f"-gencode=arch=compute_{architectures[-1]},code=compute_{architectures[-1]}"], check=True)
    return result.read_bytes()


def misjudged(taken, found, broken):
    """One line for each kernel that is judged otherwise than it must be."""
    for architecture in sorted(taken):
        for name, rules in broken.items():
            here = {finding.rule for finding in found
                    if finding.kernel == name and finding.architecture.startswith((f"sm_{architecture}", "compute_"))}
            if here != rules:
                yield f"sm_{architecture}: {name}: {', '.join(sorted(here)) or 'nothing'} found; expected " \
                      f"{', '.join(sorted(rules)) or 'nothing'}"


def self_check(nvcc):
    failures = []
    with tempfile.TemporaryDirectory() as folder:
        for number, option in enumerate(("--fmad=false", "--fmad=true")):
            taken, found = check(compile_probes(nvcc, folder, "--no-compress", option))
            broken = {name: rules[number] for name, rules in BROKEN.items()}
            failures += [f"{option}: {failure}" for failure in misjudged(taken, found, broken)]
    print("\n".join(failures) or f"{len(BROKEN)} kernels judged as they must be")
    return 1 if failures else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", help="library; with --self-check the compiler")
    parser.add_argument("--table", action="store_true")
    parser.add_argument("--self-check", action="store_true")
    arguments = parser.parse_args()
    if arguments.self_check:
        return self_check(arguments.file)
    try:
        taken, found = check(Path(arguments.file).read_bytes())
    except (OSError, Unreadable) as problem:
        print(f"{arguments.file}: {problem}", file=sys.stderr)
        return 2
    if arguments.table:
        print_table(taken)
        return 0
    print_findings(found)
    if not found:
        kernels = set().union(*taken.values())
        print(f"{len(kernels)} kernels on {len(taken)} architectures: no stack, registers within their budgets, nothing fused")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
