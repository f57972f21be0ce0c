#!/usr/bin/env python3
"""Makes the tables of docs/performance.md from Google Benchmark's JSON, with what each figure is to reach beside it:
tables.py deformation FILE, or tables.py others FILE [FILE of the files' benchmarks with a photograph]. Every figure is a ratio within one run, but for a few times that are
asked for as times; the deformation's are the medians of their repetitions."""

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


# (row, benchmark, counter or clock, what it is to reach: at least or at most)
OTHERS = [
    ("PNG, default: times stb_image_write's speed", "encode_png_against_stb/default", "stb_time", ">= 7"),
    ("PNG, default: its size over ours", "encode_png_against_stb/default", "stb_size", "> 1"),
    ("PNG, fast: times stb_image_write's speed", "encode_png_against_stb/fast", "stb_time", ""),
    ("PNG, fast: its size over ours", "encode_png_against_stb/fast", "stb_size", ""),
    ("PNG, small: libpng's size at 9, all filters, over ours", "encode_small_png_against_libpng", "libpng_size", ">= 1"),
    ("PNG, small: times its speed", "encode_small_png_against_libpng", "libpng_time", ""),
    ("PNG opens: times libspng's speed", "open_against/spng", "spng_time", ">= 1"),
    ("JPEG opens: times libjpeg-turbo's speed", "open_against/libjpeg", "libjpeg_time", ">= 1"),
    ("JPEG is written: times libjpeg-turbo's speed", "encode_jpeg_against_libjpeg", "libjpeg_time", ">= 1"),
    ("render JPEG to PNG: time over decoding and encoding", "program_against_its_files/jpeg", "1/files_time", "<= 1.5"),
    ("render PNG to PNG: likewise", "program_against_its_files/png", "1/files_time", "<= 1.5"),
    ("render: memory over the decoded picture's", "program_against_its_files/jpeg", "memory", "<= 3"),
    ("drawing alone: the processor's speed over a software rasteriser's", "draw_by_processor", "over_driver", ""),
    ("render of 512 pixels, ms", "render_of_512_pixels", "real_time", "<= 250"),
    ("first frame of the window, ms", "start_to_window", "real_time", "<= 300"),
    ("first frame with a picture, ms", "start_to_picture", "real_time", ""),
    ("frame of a drag over drawing alone, 100 cells", "drag_frame_by_processor/100", "over_drawing", "1"),
    ("frame of a drag over drawing alone, 1000 cells", "drag_frame_by_processor/1000", "over_drawing", "1"),
    ("drawing all of 1000 cells, over what the window draws", "drawing_as_seen/1000", "times_all", ""),
]

# One benchmark for each scheme follows the slash.
SCHEME_COSTS = [
    ("first, 100 x 100 cells, 20 probes", "first_binding/{}/100"),
    ("a rest moved, 100 x 100 cells, 20 probes", "binding_after_a_probe_moved/{}/100"),
    ("first, 300 x 300 cells, 20 probes", "first_binding/{}/300"),
    ("a rest moved, 300 x 300 cells, 20 probes", "binding_after_a_probe_moved/{}/300"),
    ("a rest moved, 1002001 vertices, 16 probes, deformed", "rest_moved/{}/1000"),
    ("a probe more or less, 1002001 vertices, 16 probes, deformed", "probe_more_or_less/{}/1000"),
]
SCHEMES = ["inverse-distance", "gaussian", "geodesic", "harmonic", "biharmonic"]
PAINT_COSTS = [("a dab, 30 probes", "dab_to_vertices/{}"), ("the first dab of all", "first_dab/{}"),
               ("a probe's paint filled or cleared", "fill_or_clear/{}")]


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


def deformation(results):
    found = medians(results["benchmarks"])
    print(machine(results["context"]) + "\n")
    print("| vertices x probes (to reach) | " + " | ".join(name for _, name in SIZES) + " |")
    print("|---|" + "---|" * len(SIZES))
    for row, over, under, clock, targets in ROWS:
        cells = [cell(found, over, under, clock, size, t) for (size, _), t in zip(SIZES, targets)]
        print(f"| {row} | " + " | ".join(cells) + " |")
    blends(results["benchmarks"])


def by_name(results):
    """{name: its benchmark}, of "dab_to_vertices/100/iterations:189", "drag_frame_by_processor/cells:100" and the like"""
    return {"/".join(part for part in b["name"].replace("cells:", "").split("/") if ":" not in part and not part.endswith("_time")): b
            for b in results["benchmarks"]}


def field_of(found, benchmark, field):
    if benchmark not in found or found[benchmark].get("error_occurred"):
        return "-"
    if field.startswith("1/"):
        return figure(1 / found[benchmark][field[2:]])
    return figure(found[benchmark][field])


def others(results, photograph=None):
    found = by_name(results)
    with_photograph = by_name(photograph) if photograph else {}

    def of(benchmark, field):
        return field_of(found, benchmark, field)

    print("| 24 megapixels, and the window | measured | with a photograph | to reach |\n|---|---|---|---|")
    for row, benchmark, field, target in OTHERS:
        print(f"| {row} | {of(benchmark, field)} | {field_of(with_photograph, benchmark, field)} | {target} |")
    print("\n| weights, ms | " + " | ".join(SCHEMES) + " |\n|---|" + "---|" * len(SCHEMES))
    for row, pattern in SCHEME_COSTS:
        print(f"| {row} | " + " | ".join(of(pattern.format(scheme), "real_time") for scheme in SCHEMES) + " |")
    print("\n| paint to deformed vertices, ms | 10201 vertices | 1002001 vertices |\n|---|---|---|")
    for row, pattern in PAINT_COSTS:
        print(f"| {row} | {of(pattern.format(100), 'real_time')} | {of(pattern.format(1000), 'real_time')} |")


def main():
    results = []
    for name in sys.argv[2:]:
        with open(name, encoding="utf-8") as file:
            results.append(json.load(file))
    {"deformation": deformation, "others": others}[sys.argv[1]](*results)


if __name__ == "__main__":
    main()
