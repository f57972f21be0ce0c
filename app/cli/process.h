// What the program asks of the system before it does anything else.
#pragma once

namespace probewarp {

/// Makes sure of three things. Descriptors 0 to 2 are open, so that no file becomes a standard stream where
/// one was closed; what is written to one that was closed fails, as it should. Writing to a pipe that nobody
/// reads, or beyond a limit, is an error that can be told rather than a signal. A signal that ends the
/// program leaves no temporary file.
void prepare_process();

/// Where the system starts no threads for the cores that there are, everything runs on the threads that there
/// are already: the library that shares work among the cores cannot bear that one does not start.
void limit_threads_to_what_starts();

}  // namespace probewarp
