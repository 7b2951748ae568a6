#include "scene/scene_file_meshes.h"

#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>

#include "scene/corner_attributes.h"
#include "scene/input_error.h"
#include "scene/json_check.h"
#include "scene/motion.h"
#include "scene/printable.h"
#include "scene/scene_source.h"

namespace coppice {
namespace {

using nlohmann::json;

std::string lower_extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return extension;
}

// Polygons may have been cut into other triangles.
bool same_faces(const Scene& a, const Scene& b) {
  return a.indices == b.indices || (a.face_digest != 0 && a.face_digest == b.face_digest);
}

class MeshOpener {
 public:
  MeshOpener(const json& mesh, const std::string& name, const std::string& pointer,
             const SceneFileSources& sources)
      : mesh_(mesh), name_(name), pointer_(pointer), sources_(sources) {}

  Scene open() {
    check_keys();
    Scene scene = mesh_.contains("file")       ? open_file()
                  : mesh_.contains("built_in") ? open_built_in()
                  : mesh_.contains("sequence") ? open_sequence()
                                               : open_anim();
    stand_up(scene, mesh_.value("up", "y"));
    return scene;
  }

 private:
  [[noreturn]] void fail(const std::string& step, const std::string& what) const {
    fail_at(name_, pointer_ + step, what);
  }

  // What belongs to a kind of mesh is an error with another.
  void check_keys() const {
    std::string kind;
    for (const char* const key : {"file", "built_in", "sequence", "anim"}) {
      if (!mesh_.contains(key)) continue;
      if (!kind.empty()) fail("/" + std::string(key), "beside \"" + kind + "\", expected one of them");
      kind = key;
    }
    if (kind.empty()) fail("", "expected one of the keys \"file\", \"built_in\", \"sequence\", \"anim\"");
    const bool has_frames = kind == "sequence" || kind == "anim";
    for (const auto& [key, belongs] :
         {std::pair{"animation", kind == "file"}, std::pair{"faces", kind == "anim"},
          std::pair{"start", has_frames}, std::pair{"frames_per_second", has_frames},
          std::pair{"interpolate", has_frames}, std::pair{"repeat", has_frames}}) {
      if (mesh_.contains(key) && !belongs) fail("/" + std::string(key), "does not go with \"" + kind + "\"");
    }
    if (kind == "anim" && !mesh_.contains("faces")) {
      fail("", "key \"faces\" is missing, expected the OBJ of the first frame beside \"anim\"");
    }
  }

  // The error of what a file names, behind the place that names it.
  template <class Open>
  auto opened(const std::string& step, Open open) const {
    try {
      return open();
    } catch (const InputError& error) {
      fail(step, error.what());
    }
  }

  Scene read_mesh(const std::string& step, const std::string& path, const GltfReading& reading) const {
    if (!is_mesh_file(path)) {
      fail(step,
           "'" + printable(std::string_view(path)) +
               (lower_extension(path) == ".json" ? "', a scene file in a scene file is not read" : "'") +
               ", expected an .obj, .gltf, .glb or .ply");
    }
    return opened(step, [&] { return sources_.mesh(path, reading); });
  }

  Scene open_file() const {
    const std::string path = mesh_["file"].get<std::string>();
    GltfReading reading;
    if (mesh_.contains("animation")) {
      if (const std::string extension = lower_extension(path); extension != ".gltf" && extension != ".glb") {
        fail("/animation", "does not go with a file that is not glTF");
      }
      reading.animation = mesh_["animation"].get<std::string>();
    }
    return read_mesh("/file", path, reading);
  }

  Scene open_built_in() const {
    return opened("/built_in", [&] { return sources_.built_in(mesh_["built_in"].get<std::string>()); });
  }

  std::vector<std::string> sequence_files() const {
    const json& sequence = mesh_["sequence"];
    if (sequence.contains("files") == sequence.contains("pattern")) {
      fail("/sequence", "expected one of the keys \"files\", \"pattern\"");
    }
    if (sequence.contains("files")) {
      for (const char* const key : {"first", "last"}) {
        if (sequence.contains(key)) fail("/sequence/" + std::string(key), "does not go with \"files\"");
      }
      return sequence["files"].get<std::vector<std::string>>();
    }
    const std::string pattern = sequence["pattern"].get<std::string>();
    const std::size_t begin = pattern.find('#');
    if (begin == pattern.npos)
      fail("/sequence/pattern", shortened(sequence["pattern"]) + ", expected # for digits");
    const std::size_t end = std::min(pattern.find_first_not_of('#', begin), pattern.size());
    if (!sequence.contains("last")) fail("/sequence", "key \"last\" is missing, \"pattern\" needs it");
    const int first = sequence.value("first", 0), last = sequence["last"].get<int>();
    if (last < first || last - first >= 1'000'000) {
      fail("/sequence/last", std::to_string(last) + ", expected a number from the first, " +
                                 std::to_string(first) + ", to a million more");
    }
    std::vector<std::string> files;
    for (int i = first; i <= last; ++i) {
      std::string digits = std::to_string(i);
      if (digits.size() < end - begin) digits.insert(0, end - begin - digits.size(), '0');
      files.push_back(pattern.substr(0, begin) + digits + pattern.substr(end));
    }
    return files;
  }

  Scene open_sequence() const {
    const std::vector<std::string> files = sequence_files();
    Scene scene;
    VertexSequence sequence;
    for (std::size_t i = 0; i < files.size(); ++i) {
      const bool is_listed = mesh_["sequence"].contains("files");
      const std::string step = is_listed ? "/sequence/files/" + std::to_string(i) : "/sequence/pattern";
      Scene frame = read_mesh(step, files[i], {});
      if (frame.motion)
        fail(step, "'" + printable(std::string_view(files[i])) + "' moves, expected a still mesh");
      for (glm::vec3& p : frame.positions) p = glm::vec3(glm::dvec3(p) + frame.offset);
      frame.offset = glm::dvec3{0};
      if (i == 0) {
        scene = frame;
      } else if (frame.positions.size() != scene.positions.size() || !same_faces(frame, scene)) {
        fail(step, "'" + printable(std::string_view(files[i])) + "' has other faces than '" +
                       printable(std::string_view(files[0])) + "', expected the same in all frames");
      }
      sequence.positions.insert(sequence.positions.end(), frame.positions.begin(), frame.positions.end());
    }
    return with_sequence(std::move(scene), std::move(sequence));
  }

  Scene open_anim() const {
    Scene faces = read_mesh("/faces", mesh_["faces"].get<std::string>(), {});
    if (faces.motion) fail("/faces", "moves, expected a still mesh");
    const std::string path = mesh_["anim"].get<std::string>();
    Scene scene = opened("/anim", [&] {
      return make_anim_scene(sources_.bytes(path), printable(std::string_view(path)), std::move(faces));
    });
    VertexSequence sequence = scene.motion->sequences[0];
    return with_sequence(std::move(scene), std::move(sequence));
  }

  Scene with_sequence(Scene scene, VertexSequence sequence) const {
    sequence.vertices = {0, static_cast<std::uint32_t>(scene.positions.size())};
    sequence.first_second = mesh_.value("start", 0.0);
    sequence.frames_per_second = mesh_.value("frames_per_second", 30.0);
    sequence.interpolates = mesh_.value("interpolate", false);
    sequence.repeats = mesh_.value("repeat", false);
    if (scene.positions.empty()) return scene;
    Motion motion;
    motion.rest = scene.positions;
    const double end = sequence.first_second + sequence.frame_count() / sequence.frames_per_second;
    motion.duration_seconds = end > 0 ? end : 1;
    motion.sequences.push_back(std::move(sequence));
    scene.positions = positions_at(motion, 0);
    scene.motion = std::make_shared<Motion>(std::move(motion));
    drop_normals(scene);
    return scene;
  }

  const json& mesh_;
  const std::string& name_;
  const std::string& pointer_;
  const SceneFileSources& sources_;
};

std::uint32_t anim_word(const std::string& bytes, std::size_t index) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    word |= std::uint32_t{static_cast<unsigned char>(bytes[4 * index + i])} << (8 * i);
  }
  return word;
}

}  // namespace

Scene open_scene_file_mesh(const json& mesh, const std::string& name, const std::string& pointer,
                           const SceneFileSources& sources) {
  return MeshOpener(mesh, name, pointer, sources).open();
}

Scene make_anim_scene(const std::string& bytes, const std::string& name, Scene faces) {
  static_assert(std::endian::native == std::endian::little, "positions are copied as they are");
  const auto fail = [&](const std::string& what) { throw InputError(name + ": " + what); };
  if (bytes.size() < 16 || anim_word(bytes, 0) != 0x4d494e41)
    fail("no .anim file, expected the magic 0x4d494e41");
  const std::uint64_t vertices = anim_word(bytes, 1), frames = anim_word(bytes, 2),
                      triangles = anim_word(bytes, 3);
  if (vertices == 0 || frames == 0) fail("no vertices or no frames, expected some");
  if (vertices != faces.positions.size() || triangles != faces.indices.size()) {
    fail(std::to_string(vertices) + " vertices and " + std::to_string(triangles) +
         " triangles, expected the " + std::to_string(faces.positions.size()) + " and " +
         std::to_string(faces.indices.size()) + " of its faces");
  }
  if ((bytes.size() - 16) / 12 / vertices != frames || (bytes.size() - 16) != vertices * frames * 12) {
    fail(std::to_string(bytes.size()) + " bytes, expected 16 and 12 for each of " + std::to_string(vertices) +
         " vertices in each of " + std::to_string(frames) + " frames");
  }
  VertexSequence sequence;
  sequence.vertices = {0, static_cast<std::uint32_t>(vertices)};
  sequence.positions.resize(vertices * frames);
  std::memcpy(sequence.positions.data(), bytes.data() + 16, bytes.size() - 16);
  faces.positions.assign(sequence.positions.begin(),
                         sequence.positions.begin() + static_cast<std::ptrdiff_t>(vertices));
  faces.offset = glm::dvec3{0};
  Motion motion;
  motion.rest = faces.positions;
  motion.duration_seconds = static_cast<double>(frames) / sequence.frames_per_second;
  motion.sequences.push_back(std::move(sequence));
  faces.motion = std::make_shared<Motion>(std::move(motion));
  drop_normals(faces);
  return faces;
}

}  // namespace coppice
