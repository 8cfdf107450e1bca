// A shared library without the function every module exports.

extern "C" int something_else() {
    return 1;
}
