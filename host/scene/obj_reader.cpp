#include "scene/obj_reader.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <limits>

#include "scene/input_error.h"
#include "scene/obj_lines.h"
#include "scene/obj_polygons.h"

namespace coppice {
namespace {

// Parts of about so many bytes that end where a statement ends.
std::vector<std::string_view> split(std::string_view text, std::size_t part_bytes) {
  std::vector<std::string_view> parts;
  while (!text.empty()) {
    std::size_t end = std::min(part_bytes, text.size());
    while (end < text.size()) {
      const std::size_t line_end = text.find('\n', end - 1);
      end = line_end == text.npos ? text.size() : line_end + 1;
      // The next line may belong to this one, or be its LF after more than one CR.
      const std::size_t last = text.substr(0, end).find_last_not_of(" \t\r\n");
      if (last == text.npos || text[last] != '\\') break;
      ++end;
    }
    end = std::min(end, text.size());
    parts.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return parts;
}

ObjPart read_part(std::string_view text, glm::dvec3 offset, bool plain) {
  if (plain) {
    if (std::optional<ObjPart> part = read_plain_obj_part(text, offset)) return std::move(*part);
  }
  return read_obj_part(std::string(text), offset);
}

std::vector<ObjPart> read_parts(std::string_view text, glm::dvec3 offset, const ObjReading& reading) {
  const std::vector<std::string_view> texts = split(text, reading.part_bytes);
  std::vector<ObjPart> parts(texts.size());
  std::atomic<std::size_t> done = 0;
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
    parts[i] = read_part(texts[i], offset, reading.plain);
    const std::size_t bytes = done += texts[i].size();
    if (reading.progress) reading.progress(static_cast<double>(bytes) / static_cast<double>(text.size()));
  });
  return parts;
}

// Where a part stands in the file.
struct Place {
  std::size_t lines = 0, vertices = 0, faces = 0, triangles = 0, texcoords = 0, normals = 0;  // before it
};

constexpr const char* NO_SUCH_ATTRIBUTE =
    "corner whose texture coordinates or normal are not there, it has none";

// Puts parts together: what each could not know of the others is checked, in the file's order.
class Joining {
 public:
  Joining(std::vector<ObjPart> parts, const std::string& name, ObjWarnings& warnings)
      : parts_(std::move(parts)), name_(name), warnings_(warnings) {}

  ObjMesh join() {
    if (std::any_of(parts_.begin(), parts_.end(), [](const ObjPart& part) { return part.is_binary; })) {
      throw InputError(name_ + ": a binary file, not an OBJ file");
    }
    for (const ObjPart& part : parts_) {
      check_part(part);
      places_.push_back(end_);
      end_.lines += part.line_count;
      end_.vertices += part.positions.size();
      end_.texcoords += part.texcoords.size();
      end_.normals += part.normals.size();
      end_.faces += part.face_ends.size();
      end_.triangles += part.corners.size() - 2 * part.face_ends.size();
    }
    check_all();
    mesh_.positions.resize(end_.vertices);
    make_room_for_attributes();
    for_each_part([&](std::size_t i) {
      const auto copy_to = [](const auto& from, auto& to, std::size_t place) {
        if (!to.empty()) std::copy(from.begin(), from.end(), to.begin() + static_cast<std::ptrdiff_t>(place));
      };
      copy_to(parts_[i].positions, mesh_.positions, places_[i].vertices);
      copy_to(parts_[i].texcoords, mesh_.texcoords, places_[i].texcoords);
      copy_to(parts_[i].normals, mesh_.normals, places_[i].normals);
    });
    join_triangles();
    return std::move(mesh_);
  }

 private:
  template <class Work>
  void for_each_part(const Work& work) const {
    tbb::parallel_for(std::size_t{0}, parts_.size(), work);
  }

  void check_part(const ObjPart& part) {
    for (const ObjPart::Backward& face : part.backward) {
      if (face.vertices_needed <= static_cast<std::int64_t>(end_.vertices)) continue;
      if (part.error && part.error->line < face.line) break;
      fail(end_.lines + face.line,
           "vertex index " + std::to_string(face.index) + " is out of range: there are " +
               std::to_string(static_cast<std::int64_t>(end_.vertices) + face.vertices_before) +
               " vertices before it");
    }
    if (part.error) fail(end_.lines + part.error->line, part.error->what);
    // A vertex may follow the face that names it, so an index too large is only known at the end.
    if (part.greatest_index > greatest_index_) {
      greatest_index_ = part.greatest_index;
      greatest_line_ = end_.lines + part.greatest_line;
    }
    is_recognised_ |= part.recognised;
    warn(ObjWarning::FACE_TOO_SMALL, part.small_faces, "face with fewer than three corners, left out");
    warn(ObjWarning::NOT_FINITE, part.non_finite, "vertex with a coordinate that is no finite number");
    warn(ObjWarning::FREE_FORM, part.free_form, "curves and surfaces are not read");
    warn(ObjWarning::ATTRIBUTE_INDEX, part.odd_attributes, NO_SUCH_ATTRIBUTE);
    warn(ObjWarning::VERTEX_COLOURS, part.coloured, "colours of vertices are not used");
  }

  void check_all() {
    if (!is_recognised_) throw InputError(name_ + ": not an OBJ file: no statement of the format in it");
    if (greatest_index_ > static_cast<std::int64_t>(end_.vertices)) {
      fail(greatest_line_, "vertex index " + std::to_string(greatest_index_) +
                               " is out of range: the file has " + std::to_string(end_.vertices) +
                               (end_.vertices == 1 ? " vertex" : " vertices"));
    }
    if (end_.vertices > std::numeric_limits<std::uint32_t>::max() ||
        end_.triangles > std::numeric_limits<std::uint32_t>::max()) {
      throw InputError(name_ + ": more than 2^32 vertices or triangles");
    }
    if (end_.faces == 0) warnings_.add(ObjWarning::NO_FACES, name_, "no faces");
  }

  // What no face uses is not kept.
  void make_room_for_attributes() {
    const auto are_used = [&](ObjAttribute ObjPart::*attribute) {
      return std::ranges::any_of(parts_,
                                 [&](const ObjPart& part) { return !(part.*attribute).of_corner.empty(); });
    };
    if (end_.texcoords > 0 && are_used(&ObjPart::corner_texcoords)) {
      mesh_.texcoords.resize(end_.texcoords);
      mesh_.texcoord_index.resize(end_.triangles, glm::uvec3(NO_ATTRIBUTE));
    }
    if (end_.normals > 0 && are_used(&ObjPart::corner_normals)) {
      mesh_.normals.resize(end_.normals);
      mesh_.normal_index.resize(end_.triangles, glm::uvec3(NO_ATTRIBUTE));
    }
  }

  // Counted from the file's begin; returns how many there are not. A part whose corners have none, or a file
  // without any, has an empty list.
  static std::size_t settle(ObjAttribute& attribute, std::size_t corners, std::size_t before,
                            std::size_t count) {
    if (attribute.of_corner.empty()) return 0;
    attribute.of_corner.resize(corners, NO_ATTRIBUTE);
    std::size_t missing = 0;
    for (const std::uint32_t at : attribute.relative) {
      attribute.of_corner[at] += static_cast<std::uint32_t>(before);
      missing += attribute.of_corner[at] == NO_ATTRIBUTE;  // one before the first
    }
    for (std::uint32_t& index : attribute.of_corner) {
      if (index < count || index == NO_ATTRIBUTE) continue;
      index = NO_ATTRIBUTE;
      ++missing;
    }
    if (count == 0) attribute.of_corner.clear();
    return missing;
  }

  void join_triangles() {
    std::vector<ObjFinding> crossing(parts_.size());
    std::vector<std::vector<ObjMesh::MaterialUse>> uses(parts_.size());
    std::vector<FaceDigest> faces(parts_.size());
    std::vector<std::size_t> missing(parts_.size());
    mesh_.triangles.resize(end_.triangles);
    for_each_part([&](std::size_t i) {
      ObjPart& part = parts_[i];
      missing[i] = settle(part.corner_texcoords, part.corners.size(), places_[i].texcoords, end_.texcoords) +
                   settle(part.corner_normals, part.corners.size(), places_[i].normals, end_.normals);
      faces[i] = cut_faces(i, crossing[i], uses[i]);
    });
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      end_.lines = places_[i].lines;
      warnings_.add(ObjWarning::ATTRIBUTE_INDEX, name_, NO_SUCH_ATTRIBUTE, missing[i]);
      mesh_.faces.add(faces[i]);
      warn(ObjWarning::POLYGON_CROSSES, crossing[i],
           "polygon with edges that cross or go round twice, cut into triangles that may overlap");
      std::move(uses[i].begin(), uses[i].end(), std::back_inserter(mesh_.uses));
      for (ObjPart::Library& library : parts_[i].libraries) {
        mesh_.libraries.push_back({std::move(library.names), places_[i].lines + library.line});
      }
    }
  }

  // A part's faces as triangles, and where its materials begin among them.
  FaceDigest cut_faces(std::size_t i, ObjFinding& crossing, std::vector<ObjMesh::MaterialUse>& uses) {
    ObjPart& part = parts_[i];
    FaceDigest digest;
    const Place& place = places_[i];
    for (const std::uint32_t at : part.relative) {
      part.corners[at] += static_cast<std::uint32_t>(place.vertices);
    }
    PolygonCutter cutter(part, mesh_);
    std::size_t triangle = place.triangles, begin = 0, polygon = 0;
    auto use = part.uses.begin();
    const auto begin_uses = [&](std::size_t face) {
      for (; use != part.uses.end() && use->face == face; ++use) {
        uses.push_back({triangle, std::move(use->name), place.lines + use->line});
      }
    };
    for (std::size_t face = 0; face < part.face_ends.size(); ++face) {
      begin_uses(face);
      const std::size_t end = part.face_ends[face];
      const std::uint32_t* const corners = part.corners.data() + begin;
      digest.add(place.faces + face, {corners, end - begin});
      if (end - begin == 3) {
        mesh_.triangles[triangle] = {corners[0], corners[1], corners[2]};
        if (cutter.has_attributes()) cutter.set_attributes(triangle, begin, {0, 1, 2});
        ++triangle;
      } else {
        if (!cutter.cut(begin, end, triangle)) crossing.add(part.polygon_lines[polygon]);
        ++polygon;
        triangle += end - begin - 2;
      }
      begin = end;
    }
    begin_uses(part.face_ends.size());
    return digest;
  }

  void warn(ObjWarning kind, const ObjFinding& finding, const char* what) {
    if (finding.count > 0) warnings_.add(kind, at(end_.lines + finding.line), what, finding.count);
  }

  std::string at(std::size_t line) const { return name_ + ":" + std::to_string(line); }

  [[noreturn]] void fail(std::size_t line, const std::string& what) const {
    throw InputError(at(line) + ": " + what);
  }

  std::vector<ObjPart> parts_;
  const std::string& name_;
  ObjWarnings& warnings_;
  std::vector<Place> places_;
  Place end_;
  std::int32_t greatest_index_ = 0;
  std::size_t greatest_line_ = 0;
  bool is_recognised_ = false;
  ObjMesh mesh_;
};

}  // namespace

ObjMesh read_obj_mesh(std::string_view text, const std::string& name, glm::dvec3 offset,
                      const ObjReading& reading, ObjWarnings& warnings) {
  return Joining(read_parts(without_padding(text), offset, reading), name, warnings).join();
}

}  // namespace coppice
