#include <algorithm>

#include "interface/copy.h"

namespace coppice::twins {

void copy_words(const CopyWordsArgs& args) { std::copy_n(&args.source[0], args.quad_count, &args.target[0]); }

}  // namespace coppice::twins
