#pragma once

namespace nuvo::app {

/// Parses the command line, runs what it asks for and maps every failure to its exit code:
/// 0 done, 1 pictures differ, 2 usage, 3 scene refused, 4 cannot write or out of memory.
int run(int argc, char** argv);

}  // namespace nuvo::app
