// A shared library without what every module has.

extern "C" int something_else() {
    return 1;
}
