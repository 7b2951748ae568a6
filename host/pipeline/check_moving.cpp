#include "pipeline/check_moving.h"

#include <limits>

#include "interface/vertex.h"
#include "pipeline/check_inputs.h"
#include "pipeline/instances.h"
#include "stages/stages.h"

namespace coppice {

namespace {

// Several workgroups of every stage.
constexpr std::uint32_t check_vertices = 2 * VERTEX_TILE + 100, check_instances = 200;
constexpr std::uint32_t mesh_triangles[] = {300, 40}, instance_rays = 3 * TRACE_GROUP;
constexpr std::uint32_t deform_kinds = 5;

constexpr const char* wrong_vertices = "moves vertices wrong";
constexpr const char* wrong_instances = "moves or places instances wrong";

class VertexCheck {
 public:
  explicit VertexCheck(CheckChain& chain) : chain_(chain) {}

  void add() {
    constexpr std::uint32_t coordinates = 3 * check_vertices;
    const Slot<float> frames = chain_.add("frames", random_floats(2 * coordinates));
    const Slot<float> offsets = chain_.add("offsets", random_floats(coordinates));
    const auto step = chain_.add("sequence_step", std::vector<SequenceStep>{{0, 1, 0.3f, 0}});
    const auto weight = chain_.add("weight", std::vector<float>{0.7f});
    const Slot<float> between = out("between"), morphed = out("morphed");
    chain_.append([=](Chain& chain) {
      chain.run(stages::vertex_sequence,
                {chain.at(frames), chain.at(step), chain.at(between), coordinates, 0},
                groups_of(coordinates, VERTEX_TILE));
      chain.run(stages::vertex_morph,
                {chain.at(offsets), chain.at(weight), chain.at(between), chain.at(morphed), coordinates, 0},
                groups_of(coordinates, VERTEX_TILE));
    });
    add_deformations(morphed);
    add_pose(morphed);
  }

 private:
  std::vector<float> random_floats(std::size_t count) {
    std::vector<float> values(count);
    for (float& value : values) value = random_.next_signed();
    return values;
  }

  Slot<float> out(const char* name) {
    const Slot<float> slot = chain_.layout().add<float>(name, 3 * check_vertices);
    chain_.compare(slot, wrong_vertices);
    return slot;
  }

  void add_deformations(const Slot<float>& from) {
    for (uint kind = 0; kind < deform_kinds; ++kind) {
      const auto how = chain_.add(
          "deformation", std::vector<DeformStep>{{{0.1f, -0.5f, 0.2f}, 2, 0.5f, 0.3f, 0.4f, kind, 6, 0}});
      const Slot<float> bent = out("bent");
      chain_.append([=](Chain& chain) {
        chain.run(stages::vertex_deform, {chain.at(how), chain.at(from), chain.at(bent), check_vertices, 0},
                  groups_of(check_vertices, VERTEX_TILE));
      });
    }
  }

  void add_pose(const Slot<float>& from) {
    std::vector<Joint> joints(4);
    for (Joint& joint : joints) {
      for (vec4& row : joint.rows) row = {random_.next_signed_vec3(), random_.next_signed()};
    }
    std::vector<VertexJoints> by(check_vertices);
    for (uint v = 0; v < check_vertices; ++v)
      by[v] = {{v % 4 | 1u << 16, 2u | 3u << 16}, {random_.next_signed_vec3(), v % 3 == 0 ? 0.0f : 0.5f}, {}};
    const auto joint_slot = chain_.add("joints", joints);
    const auto by_slot = chain_.add("vertex_joints", by);
    const Slot<float> posed = out("posed");
    chain_.append([=](Chain& chain) {
      chain.run(stages::vertex_pose,
                {chain.at(from), chain.at(by_slot), chain.at(joint_slot), chain.at(posed), check_vertices, 0},
                groups_of(check_vertices, VERTEX_TILE));
    });
  }

  CheckChain& chain_;
  CheckRandom random_;
};

class InstanceCheck {
 public:
  InstanceCheck(CheckChain& chain, const BuildOptions& options, std::uint32_t max_turns)
      : chain_(chain),
        plan_(plan_instances(chain.layout(), mesh_triangles, check_instances, options)),
        max_turns_(max_turns) {}

  void add() {
    upload_meshes();
    add_places();
    add_rays();
    add_hits_in_place();
  }

 private:
  void upload_meshes() {
    for (std::uint32_t mesh = 0; mesh < std::size(mesh_triangles); ++mesh) {
      std::vector<Triangle> triangles(mesh_triangles[mesh]);
      for (Triangle& t : triangles) {
        t.a = random_.next_signed_vec3();
        t.b = t.a + random_.next_signed_vec3() * 0.3f;
        t.c = t.a + random_.next_signed_vec3() * 0.3f;
      }
      chain_.upload(triangles_of(plan_, mesh), std::span<const Triangle>(triangles));
    }
    std::vector<uint> mesh_index(check_instances);
    for (uint i = 0; i < check_instances; ++i) mesh_index[i] = i % 2;
    chain_.upload(plan_.meshes, std::span<const MeshRange>(plan_.ranges));
    chain_.upload(plan_.mesh_index, std::span<const uint>(mesh_index));
  }

  // Both of them, and the trees.
  void add_places() {
    std::vector<InstanceTransform> rest(check_instances);
    for (InstanceTransform& t : rest)
      t = {random_.next_signed_vec3(), 8 * random_.next_signed(),  random_.next_signed_vec3(),
           4 * random_.next_signed(),  random_.next_signed_vec3(), 8 * random_.next_signed()};
    const SwarmSlots swarm{chain_.add("rest", rest), chain_.add("turn", std::vector<uint>{0x12345678u})};
    plan_top_refit(chain_.layout(), plan_, max_turns_);  // for the triangles that have the boxes
    chain_.append([=, plan = plan_](Chain& chain) {
      append_all_meshes(chain, plan);
      append_moves(chain, plan, swarm, 3);
      append_top(chain, plan);
    });
    chain_.compare(plan_.transforms, wrong_instances);
    chain_.compare(plan_.placed, wrong_instances);
    chain_.compare(plan_.corners, wrong_instances);
    chain_.compare(plan_.instance_boxes, wrong_instances);
    chain_.compare(plan_.mesh_height, wrong_instances);
    chain_.compare(plan_.top.nodes, "computes a wrong tree");
  }

  void add_rays() {
    constexpr float far = std::numeric_limits<float>::infinity();
    std::vector<Ray> rays(instance_rays);
    for (Ray& ray : rays) {
      ray.origin = 10.0f * random_.next_signed_vec3();
      ray.direction = 6.0f * random_.next_signed_vec3() - ray.origin;
      ray.t_min = 0;
      ray.t_max = far;
    }
    Layout& layout = chain_.layout();
    const RaySlots slots{chain_.add("rays", rays),
                         layout.add<Hit>("hits", instance_rays),
                         layout.add<TraceCounters>("counters", 1),
                         {}};
    const auto instances = layout.add<uint>("hit_instances", instance_rays);
    TraceOptions options;
    options.max_turns = max_turns_;
    chain_.append([=, plan = plan_](Chain& chain) {
      append_misses(chain, slots, instance_rays);
      append_instance_hits(chain, plan, slots, instances, instance_rays, options);
    });
    chain_.compare(slots.hits, "finds wrong hits", Nearly::hits);
    chain_.compare(instances, "finds wrong hits", Nearly::hit_instances);
  }

  // Hits that every device has alike.
  void add_hits_in_place() {
    std::vector<Hit> hits;
    std::vector<uint> instances;
    for (uint i = 0; i < instance_rays; ++i) {
      instances.push_back(i * 7 % check_instances);
      hits.push_back({1, i % 5 == 0 ? NO_TRIANGLE : i % mesh_triangles[instances[i] % 2], 0.25f, 0.25f});
    }
    PlacedHitSlots placed = plan_placed_hits(chain_.layout(), plan_, instance_rays, true);
    placed.hit_instances = chain_.add("given_instances", instances);
    std::vector<uint> materials(placed.mesh_materials.count);
    for (uint i = 0; i < materials.size(); ++i) materials[i] = i % 11;
    chain_.upload(placed.mesh_materials, std::span<const uint>(materials));
    RaySlots slots;
    slots.hits = chain_.add("given_hits", hits);
    chain_.append([=, plan = plan_](Chain& chain) {
      append_placed_hits(chain, plan, slots, placed, 0, instance_rays);
    });
    chain_.compare(slots.hits, wrong_instances);
    chain_.compare(placed.triangles, wrong_instances);
    chain_.compare(placed.material_index, wrong_instances);
    chain_.compare(placed.primitives, wrong_instances);
  }

  CheckChain& chain_;
  CheckRandom random_;
  InstancePlan plan_;
  std::uint32_t max_turns_;
};

}  // namespace

void add_vertex_check(CheckChain& chain) { VertexCheck(chain).add(); }

void add_instance_check(CheckChain& chain, const BuildOptions& options, std::uint32_t max_turns) {
  InstanceCheck(chain, options, max_turns).add();
}

}  // namespace coppice
