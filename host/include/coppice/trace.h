// Rays through a tree, recorded into the caller's command buffer. Ordering and memory: coppice/build.h.
#pragma once

#include "coppice/build.h"

namespace coppice {

// Which tree rays walk. All give the same hits.
enum class TraceTree {
  automatic,  // wide_single where the tree has wide nodes, else binary
  binary,
  wide_packets,  // rays next to each other go together: fast where they go the same way, as from a camera
  wide_single,
};

// Of a call: what one dispatch takes on every device.
inline constexpr std::uint32_t MAX_RAYS = 65535 * 64;

struct RayInput {
  VkDeviceAddress rays = 0;  // CoppiceRay; a multiple of 16
  ElementCount count{};      // at most MAX_RAYS
  // A ray sees a primitive where their masks have a bit in common.
  std::uint32_t ray_mask = 0xff;  // of all rays
  VkDeviceAddress ray_masks = 0;  // a word a ray, combined with ray_mask by and; a multiple of 4; null: none
  VkDeviceAddress primitive_flags = 0;  // a word a primitive: its mask in bits 0 to 7, and
                                        // COPPICE_PRIMITIVE_NOT_OPAQUE; a multiple of 4; null: 0xff each
};

// Traces of trees of any size; one can be used by several threads at once. What goes wrong sets bits of the
// error word in the tree's state; they stay there until the tree is built anew or you clear them.
class COPPICE_API Tracer {
 public:
  // Compiles the kernels that are not yet compiled, and lets the device be checked; throws DeviceError for
  // one that finds wrong hits.
  explicit Tracer(const Context& context, TraceTree tree = TraceTree::automatic);
  ~Tracer();
  Tracer(Tracer&&) noexcept;

  VkDeviceSize scratch_bytes() const;  // of each call, which leaves its counters there

  // The closest hit of each ray to `hits`: CoppiceHit each; a multiple of 16. All throw ArgumentError, and
  // record nothing, where an address is null or misaligned, the scratch is too small, or the tree does not
  // have what is to be walked: of a tree over boxes only candidates are found.
  void cmd_trace_closest(VkCommandBuffer commands, const TreeAddresses& tree, const RayInput& rays,
                         VkDeviceAddress hits, const MemoryRange& scratch,
                         KernelQueries* queries = nullptr) const;

  // Whether each ray hits any opaque primitive that it sees: a word each to `any_hits`, 1 or 0; a multiple
  // of 4. A ray ends at the first one; primitives that are not opaque are as if they were not there.
  void cmd_trace_any(VkCommandBuffer commands, const TreeAddresses& tree, const RayInput& rays,
                     VkDeviceAddress any_hits, const MemoryRange& scratch,
                     KernelQueries* queries = nullptr) const;

  // The primitives whose boxes each ray meets: the `capacity` nearest ones by where it enters them, of equal
  // ones the smaller primitive first, to `candidates`, CoppiceCandidate each, `capacity` a ray; a multiple
  // of 8. Of each ray the number of all that it meets to `candidate_counts`, a word each; it may be more than
  // the capacity.
  void cmd_trace_candidates(VkCommandBuffer commands, const TreeAddresses& tree, const RayInput& rays,
                            std::uint32_t capacity, VkDeviceAddress candidates,
                            VkDeviceAddress candidate_counts, const MemoryRange& scratch,
                            KernelQueries* queries = nullptr) const;

 private:
  struct Plan;
  std::unique_ptr<Plan> plan_;
};

}  // namespace coppice
