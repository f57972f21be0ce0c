// From the program's start to its first frame, to the first with a picture, and the same work on the command
// line.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <string>

namespace {

void run(benchmark::State& state, const std::string& command) {
    for (auto _ : state)
        if (std::system(command.c_str()) != 0)
            return state.SkipWithError("the program failed; is there a display?");
}

const std::string program = PROBEWARP_PROGRAM, sample = PROBEWARP_SAMPLE;

void start_to_window(benchmark::State& state) {
    run(state, "PROBEWARP_QUIT_AFTER_FIRST_FRAME=1 '" + program + "'");
}
BENCHMARK(start_to_window)->Unit(benchmark::kMillisecond)->UseRealTime();

void start_to_picture(benchmark::State& state) {
    run(state, "PROBEWARP_QUIT_AFTER_FIRST_FRAME=1 '" + program + "' '" + sample + "'");
}
BENCHMARK(start_to_picture)->Unit(benchmark::kMillisecond)->UseRealTime();

void start_to_version(benchmark::State& state) { run(state, "'" + program + "' --version >/dev/null"); }
BENCHMARK(start_to_version)->Unit(benchmark::kMillisecond)->UseRealTime();

void command_line_render(benchmark::State& state) {
    run(state,
        "'" + program + "' render '" + sample + "' -o - --format bmp --probe 512,300:520,310,5 >/dev/null");
}
BENCHMARK(command_line_render)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
