// Nothing of its own: carries the headers that clang's builds of the tests share (CMakeLists.txt).
