// The program `probewarp`: a window, or one of the command line's commands.
#include "cli/cli.h"
#include "cli/process.h"
#include "gui/window.h"

int main(int argc, char** argv) {
    probewarp::prepare_process();
    return probewarp::run_command_line(argc, argv, &probewarp::run_window);
}
