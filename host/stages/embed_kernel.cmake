# cmake -DSPIRV=<kernel>.spv -DHEADER=<kernel>.spv.h -DNAME=<kernel> -P embed_kernel.cmake
# Writes the header of a compiled kernel: its words, as an array of that name.
file(READ ${SPIRV} bytes HEX)
# The compiler names a function by its parameters' types. The size of an array that is an expression of specialization
# constants goes into such a name as the address ("[s0x...") that the expression had in the compiler: every build would
# have other bytes, and drivers would compile the kernel anew.
if(bytes MATCHES "5b733078")
  message(FATAL_ERROR "kernel ${NAME}: a parameter of a function has an array whose size is an expression of "
                      "specialization constants. Give that size a name of its own (const uint ... = ...): without one "
                      "the compiler writes an address into the kernel, another one in each run.")
endif()
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1," words "${bytes}")
string(REPEAT "0x........," 12 line)
string(REGEX REPLACE "(${line})" "\\1\n" words "${words}")
file(WRITE ${HEADER} "#pragma once\nconst uint32_t ${NAME}[] = {\n${words}};\n")
