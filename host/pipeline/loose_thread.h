#pragma once

#include <functional>

namespace coppice {

// A thread that nobody waits for: it goes on by itself until `work`, which throws nothing, is done or the
// program ends.
void start_loose_thread(std::function<void()> work);

// Whether the work of one is not done. The program then has to end by _exit: exit() would end what such a
// thread uses, tables and other libraries, before the thread.
bool has_loose_threads();

}  // namespace coppice
