#include "command.hh"

int main(int argc, char** argv) {
    return hsdm::command::run_command(argc, argv);
}
