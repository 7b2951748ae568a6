#include "scene/scene_file.h"

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>

#include "scene/input_error.h"
#include "scene/json_check.h"
#include "scene/load_ply.h"
#include "scene/obj_file.h"
#include "scene/printable.h"
#include "scene/scene_compose.h"
#include "scene/scene_file_deform.h"
#include "scene/scene_file_environment.h"
#include "scene/scene_file_fog.h"
#include "scene/scene_file_instances.h"
#include "scene/scene_file_lights.h"
#include "scene/scene_file_meshes.h"
#include "scene/scene_file_tracks.h"
#include "scene/scene_source.h"
#include "scene_schema.h"

namespace coppice {
namespace {

using nlohmann::json;

Material scene_file_material(const std::string& name, const json& from) {
  Material material;
  material.name = name;
  if (from.contains("diffuse")) material.diffuse = vector_of(from["diffuse"]);
  if (from.contains("specular")) material.specular = vector_of(from["specular"]);
  if (from.contains("emission")) material.emission = vector_of(from["emission"]);
  material.shininess = from.value("shininess", material.shininess);
  material.opacity = from.value("opacity", material.opacity);
  material.index_of_refraction = from.value("index_of_refraction", material.index_of_refraction);
  material.illum = from.value("illum", material.illum);
  if (from.contains("filter")) material.filter = vector_of(from["filter"]);
  if (from.contains("roughness")) material.roughness = from["roughness"].get<float>();
  if (from.contains("metallic")) material.metallic = from["metallic"].get<float>();
  return material;
}

class SceneFileReader {
 public:
  SceneFileReader(const json& file, const std::string& name, const SceneFileSources& sources)
      : file_(file), name_(name), sources_(sources) {}

  Scene read();

 private:
  void read_objects();
  void read_nodes(const json& objects);
  void read_parents(const json& objects);
  void check_parents(const json& objects);
  Scene mesh_of(const std::string& mesh, const std::string& pointer);
  void add_part(std::uint32_t node, const json& object, const std::string& pointer);
  void add_instance(std::uint32_t node, const json& object, const std::string& pointer);
  void set_material(Scene& mesh, const json& object, const std::string& pointer);
  void read_camera();
  bool is_instanced() const { return sources_.keeps_instances && file_.contains("instances"); }
  Scene composed();

  const json& file_;
  const std::string& name_;
  const SceneFileSources& sources_;
  Composition composition_;
  InstanceComposition instances_;
  std::map<std::array<std::string, 3>, std::uint32_t> instanced_;  // by mesh, material and deformation
  std::map<std::string, Scene> meshes_;
  std::vector<std::string> warnings_;
};

std::string object_pointer(std::size_t index) { return "/objects/" + std::to_string(index); }

std::string known_keys(const json& file, const char* key) {
  std::string known;
  if (file.contains(key)) {
    for (const auto& [name, unused] : file[key].items())
      known += (known.empty() ? "" : ", ") + printable(std::string_view(name));
  }
  return known.empty() ? "none" : known.substr(0, 300);
}

Scene SceneFileReader::mesh_of(const std::string& mesh, const std::string& pointer) {
  const auto known = meshes_.find(mesh);
  if (known != meshes_.end()) return known->second;
  if (!file_.contains("meshes") || !file_["meshes"].contains(mesh)) {
    fail_at(name_, pointer,
            "no mesh '" + printable(std::string_view(mesh)) + "', there are: " + known_keys(file_, "meshes"));
  }
  Scene scene = open_scene_file_mesh(file_["meshes"][mesh], name_, "/meshes" + pointer_step(mesh), sources_);
  warnings_.insert(warnings_.end(), scene.warnings.begin(), scene.warnings.end());
  return meshes_[mesh] = std::move(scene);
}

void SceneFileReader::set_material(Scene& mesh, const json& object, const std::string& pointer) {
  if (!object.contains("material")) return;
  const std::string material = object["material"].get<std::string>();
  if (!file_.contains("materials") || !file_["materials"].contains(material)) {
    fail_at(name_, pointer + "/material",
            "no material '" + printable(std::string_view(material)) +
                "', there are: " + known_keys(file_, "materials"));
  }
  mesh.materials = {scene_file_material(material, file_["materials"][material])};
  std::fill(mesh.material_index.begin(), mesh.material_index.end(), 0u);
}

// Each mesh is opened and kept once, with each of its materials and deformations.
void SceneFileReader::add_instance(std::uint32_t node, const json& object, const std::string& pointer) {
  const std::string name = object["mesh"].get<std::string>();
  const std::string material = object.contains("material") ? "m" + object["material"].get<std::string>() : "";
  const std::string deform = object.contains("deform") ? object["deform"].dump() : "";
  const auto next = static_cast<std::uint32_t>(instances_.meshes.size());
  const auto [known, is_new] = instanced_.try_emplace({name, material, deform}, next);
  instances_.placed.push_back({known->second, node});
  if (!is_new) return;
  Scene mesh = mesh_of(name, pointer + "/mesh");
  set_material(mesh, object, pointer);
  if (object.contains("deform"))
    add_deformation(mesh, read_deformation(object["deform"], mesh, name_, pointer + "/deform"));
  instances_.meshes.push_back(std::move(mesh));
}

void SceneFileReader::add_part(std::uint32_t node, const json& object, const std::string& pointer) {
  for (const char* const key : {"material", "deform"}) {
    if (object.contains(key) && !object.contains("mesh")) {
      fail_at(name_, pointer + "/" + key, "does not go with an object without a \"mesh\"");
    }
  }
  if (!object.contains("mesh")) return;
  if (is_instanced()) return add_instance(node, object, pointer);
  ScenePart part;
  part.node = node;
  part.scene = mesh_of(object["mesh"].get<std::string>(), pointer + "/mesh");
  set_material(part.scene, object, pointer);
  if (object.contains("deform"))
    part.deformation = read_deformation(object["deform"], part.scene, name_, pointer + "/deform");
  composition_.parts.push_back(std::move(part));
}

void SceneFileReader::read_nodes(const json& objects) {
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const std::string pointer = object_pointer(i);
    composition_.nodes.nodes.push_back(read_transform(objects[i], name_, pointer));
    read_object_tracks(objects[i], name_, pointer, static_cast<std::uint32_t>(i), composition_.nodes.tracks);
  }
}

void SceneFileReader::read_parents(const json& objects) {
  std::map<std::string, int> index_of;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (!objects[i].contains("name")) continue;
    const std::string name = objects[i]["name"].get<std::string>();
    if (!index_of.emplace(name, static_cast<int>(i)).second) {
      fail_at(name_, object_pointer(i) + "/name",
              "'" + printable(std::string_view(name)) + "' again, expected another name");
    }
  }
  std::vector<int>& parents = composition_.nodes.parents;
  parents.assign(objects.size(), -1);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (!objects[i].contains("parent")) continue;
    const std::string parent = objects[i]["parent"].get<std::string>();
    const auto found = index_of.find(parent);
    if (found == index_of.end()) {
      fail_at(name_, object_pointer(i) + "/parent",
              "'" + printable(std::string_view(parent)) + "', expected the name of an object");
    }
    parents[i] = found->second;
  }
}

// Parents before children; what is never reached goes round.
void SceneFileReader::check_parents(const json& objects) {
  const std::vector<int>& parents = composition_.nodes.parents;
  std::vector<std::vector<std::uint32_t>> children(objects.size());
  std::vector<std::uint32_t>& order = composition_.nodes.order;
  std::vector<bool> is_reached(objects.size());
  for (std::uint32_t i = 0; i < objects.size(); ++i) {
    if (parents[i] < 0) {
      order.push_back(i);
    } else {
      children[static_cast<std::size_t>(parents[i])].push_back(i);
    }
  }
  for (std::size_t done = 0; done < order.size(); ++done) {
    const std::uint32_t node = order[done];
    is_reached[node] = true;
    order.insert(order.end(), children[node].begin(), children[node].end());
  }
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (!is_reached[i])
      fail_at(name_, object_pointer(i) + "/parent", "the object is below itself (a cycle), expected a tree");
  }
}

void SceneFileReader::read_objects() {
  const json& objects = file_["objects"];
  read_nodes(objects);
  read_parents(objects);
  check_parents(objects);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    add_part(static_cast<std::uint32_t>(i), objects[i], object_pointer(i));
  }
}

void SceneFileReader::read_camera() {
  if (file_.contains("camera")) composition_.camera = read_scene_camera(file_["camera"], name_, "/camera");
}

// The scene's own camera and light turn with it.
void stand_up_whole(Scene& scene, std::string_view up) {
  std::optional<Camera> camera = scene.camera;
  const Lens lens = scene.lens;
  stand_up(scene, up);
  if (up == "y") return;
  scene.light.direction = scene.turn * scene.light.direction;  // the others have turned
  if (!camera) return;
  for (glm::vec3* const vector : {&camera->position, &camera->target, &camera->up})
    *vector = scene.turn * *vector;
  scene.camera = camera;
  scene.lens = lens;
}

Scene SceneFileReader::composed() {
  if (!is_instanced()) return compose(std::move(composition_));
  instances_.nodes = std::move(composition_.nodes);
  instances_.camera = composition_.camera;
  instances_.frames_per_second = composition_.frames_per_second;
  instances_.duration = composition_.duration;
  Scene scene = compose_instances(instances_);
  if (!scene.instances.empty()) scene.swarm = read_swarm(file_["instances"], instances_.frames_per_second);
  return scene;
}

Scene SceneFileReader::read() {
  if (is_instanced()) check_swarm(file_, name_);
  read_objects();
  read_camera();
  composition_.frames_per_second = file_.value("frames_per_second", 30.0);
  if (file_.contains("duration")) composition_.duration = file_["duration"].get<double>();
  Scene scene;
  try {
    scene = composed();
  } catch (const InputError& error) {
    fail_at(name_, "/objects", error.what());
  }
  for (std::string& warning : scene.warnings) warning.insert(0, name_ + ": ");
  scene.warnings.insert(scene.warnings.begin(), warnings_.begin(), warnings_.end());
  if (scene.indices.empty()) scene.warnings.push_back(name_ + ": no triangles");
  read_scene_lights(file_, name_, scene);
  if (file_.contains("ambient_occlusion"))
    scene.occlusion = AmbientOcclusion{file_["ambient_occlusion"].value("distance", 0.0f)};
  if (file_.contains("camera")) scene.lens = read_scene_lens(file_["camera"]);
  stand_up_whole(scene, file_.value("up", "y"));
  if (file_.contains("environment"))
    scene.environment = read_scene_environment(file_["environment"], name_, scene);
  if (file_.contains("fog")) scene.fog = read_scene_fog(file_["fog"], name_, scene);
  return scene;
}

}  // namespace

Scene parse_scene_file(std::string_view text, const std::string& name, const SceneFileSources& sources) {
  const json file = parse_json(text, name);
  check_schema(file, SCENE_SCHEMA, name);
  return SceneFileReader(file, name, sources).read();
}

Scene load_scene_file(const std::filesystem::path& path, bool keep_instances) {
  const ObjFile file = read_obj_file(path);
  const std::filesystem::path folder = path.parent_path();
  SceneFileSources sources;
  sources.mesh = [&](const std::string& mesh, const GltfReading& reading) {
    return load_mesh_file(folder / mesh, reading);
  };
  sources.built_in = [](const std::string& name) { return make_built_in(name); };
  sources.bytes = [&](const std::string& name) { return std::string(read_obj_file(folder / name).text()); };
  Scene scene = parse_scene_file(file.text(), printable(path), sources);
  if (!keep_instances && !scene.instances.empty() && scene.motion) {
    sources.keeps_instances = false;
    scene = parse_scene_file(file.text(), printable(path), sources);
  }
  scene.name = printable(path.stem());
  if (scene.environment) scene.environment->folder = folder.string();
  return scene;
}

}  // namespace coppice
