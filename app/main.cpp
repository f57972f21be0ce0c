// The program `probewarp`: a window, or one of the command line's commands.
#include <csignal>

#include "cli/cli.h"
#include "gui/window.h"

int main(int argc, char** argv) {
    std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the limit is an error that can be told, as a full disk is
    return probewarp::run_command_line(argc, argv, &probewarp::run_window);
}
