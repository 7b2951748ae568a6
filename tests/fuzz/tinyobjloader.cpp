// tinyobjloader compiled with the fuzzer, which cannot look into the system's library.
#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>
