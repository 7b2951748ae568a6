#include "twins/wide_children.h"

#include <functional>

namespace coppice::twins {

std::vector<WideChildVisit> met_children(const WideNode& node, const WideDistances& distances, float limit) {
  struct Met {
    uint key;
    WideChildVisit visit;
  };
  std::vector<Met> met;
  for (uint child = 0; child < WIDE_CHILDREN; ++child) {
    float enter;
    if (node.child[child] == WIDE_EMPTY || !distances.meet(node, child, limit, enter)) continue;
    met.push_back({(std::bit_cast<uint>(enter) & ~(WIDE_CHILDREN - 1)) | child,
                   {WideDistances::kept_bits(enter), node.child[child]}});
  }
  std::ranges::sort(met, std::greater(), &Met::key);
  std::vector<WideChildVisit> visits;
  for (const Met& child : met) visits.push_back(child.visit);
  return visits;
}

}  // namespace coppice::twins
