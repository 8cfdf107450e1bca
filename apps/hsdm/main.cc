#include "command.hh"

int main(int argc, char** argv) {
    hsdm::command::prepare_process();
    return hsdm::command::run_command(argc, argv);
}
