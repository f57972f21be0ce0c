#!/usr/bin/env python3
"""Makes the deformation's table from Google Benchmark's JSON: every figure is a ratio within one run, and the
median of its repetitions, with what it is to reach beside it."""

import json
import sys

SIZES = [((100, 8), "10201x8"), ((200, 32), "40401x32"), ((1000, 16), "1002001x16"), ((1000, 64), "1002001x64")]

# (row, of one benchmark over the other, which clock, targets). One thread is measured by the processor's clock,
# which other programs on the machine disturb less; several by the wall's.
ROWS = [
    ("all probes, times direct, one thread", "deform_direct", "deform_tiles", "cpu_time", [14, 22, 13, 14]),
    ("one probe dragged, times direct", "deform_direct", "deform_dragged", "cpu_time", [40, 150, 55, 190]),
    ("share of read bandwidth", "limit_read", "deform_tiles", "cpu_time", [None, None, 0.95, 0.95]),
    ("share of peak multiply-add", "limit_multiply_add", "deform_tiles", "cpu_time", [None] * 4),
    ("two threads over one", "deform_tiles", "deform_tiles_two_threads", "real_time", [1.5, 1.8, 1.8, 1.8]),
    ("reading alone, times direct (what bandwidth allows)", "deform_direct", "limit_read", "cpu_time", [None] * 4),
    ("plain function, times direct", "deform_direct", "deform_plain", "cpu_time", [None] * 4),
    ("2x3 matrices, times direct", "deform_direct", "deform_matrices", "cpu_time", [None] * 4),
    ("dual quaternions, times direct", "deform_direct", "deform_quaternions", "cpu_time", [None] * 4),
    ("making the tiles, over deforming once", "deform_make_tiles", "deform_tiles", "cpu_time", [None] * 4),
]


def medians(benchmarks):
    """{(name, arguments): its median}"""
    found = {}
    for b in benchmarks:
        if b.get("aggregate_name") == "median":
            name, *arguments = b["run_name"].removesuffix("/real_time").split("/")
            found[name, tuple(int(a) for a in arguments if a.isdigit())] = b
    return found


def figure(value):
    return f"{value:.2f}" if value < 10 else f"{value:.0f}"


def cell(found, over, under, clock, size, target):
    if (over, size) not in found or (under, size) not in found:
        return "-"
    value = found[over, size][clock] / found[under, size][clock]
    return figure(value) + (f" ({target})" if target else "")


def machine(context):
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        models = [line.split(":")[1].strip() for line in file if line.startswith("model name")]
    caches = ", ".join(f"L{c['level']} {c['size'] // 1024} KB" for c in context["caches"] if c["type"] != "Instruction")
    load = context.get("load_avg", [0])[0]
    return (f"{models[0] if models else 'unknown processor'}, {context['num_cpus']} cores, {caches}; "
            f"{context.get('instruction set', '?')}; load when it began: {load:.1f}")


def blends(benchmarks):
    """The second table: each blend's time over DLB's, one thread."""
    found = [b for b in benchmarks if b.get("aggregate_name") == "median" and b["run_name"].startswith("deform_blend/")]
    found.sort(key=lambda b: int(b["run_name"].split("/")[3]))  # its place in the program's table
    times = {(b["label"], tuple(b["run_name"].split("/")[1:3])): b["cpu_time"] for b in found}
    sizes = [(tuple(str(n) for n in size), name) for size, name in SIZES if ("dlb", tuple(map(str, size))) in times]
    print("\n| blend, over DLB's time | " + " | ".join(name for _, name in sizes) + " |")
    print("|---|" + "---|" * len(sizes))
    for blend in dict.fromkeys(label for label, _ in times):
        cells = [figure(times[blend, size] / times["dlb", size]) for size, _ in sizes]
        print(f"| {blend} | " + " | ".join(cells) + " |")


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        results = json.load(file)
    found = medians(results["benchmarks"])
    print(machine(results["context"]) + "\n")
    print("| vertices x probes (to reach) | " + " | ".join(name for _, name in SIZES) + " |")
    print("|---|" + "---|" * len(SIZES))
    for row, over, under, clock, targets in ROWS:
        cells = [cell(found, over, under, clock, size, t) for (size, _), t in zip(SIZES, targets)]
        print(f"| {row} | " + " | ".join(cells) + " |")
    blends(results["benchmarks"])


if __name__ == "__main__":
    main()
