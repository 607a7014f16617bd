#include "nuvo/app/program.h"

int main(int argc, char** argv) { return nuvo::app::run(argc, argv); }
