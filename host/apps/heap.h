#pragma once

namespace coppice {

// Settles how this process' heap grows: to be called first in main. Memory that one build gives back serves
// the next, and large blocks lie in huge pages where the system has them: fetching memory from the kernel
// page by page, each when it is first touched, takes up to half of a build of a million triangles or of
// reading a file.
void settle_heap();

}  // namespace coppice
