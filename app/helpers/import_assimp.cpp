/* Reads a mesh file with assimp behind an interface in C: one importer, one block of memory, and no other file. */
#include "app/helpers/import_assimp.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <sstream>
#include <string>
#include <vector>

#include <assimp/DefaultLogger.hpp>
#include <assimp/GltfMaterial.h>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/importerdesc.h>
#include <assimp/LogStream.hpp>
#include <assimp/material.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

extern "C" {
#if SPORE_HAVE_PNG
#include "app/helpers/atlas.h"
#endif
#if SPORE_HAVE_JPEG
#include "app/helpers/photograph.h"
#endif
#include "core/io/import_wire.h"
#include "core/math/colour.h"
}

#define N_(text) text

namespace {

constexpr uint64_t most_elements = 20000000; /* as SPORE_MESH_MAXIMUM */

struct Refusal {
  SporeErrorCode code;
  const char *message;
  std::string detail;
};

/* The content is the only file. Any other file that an importer asks for does not exist. */
class OneFile : public Assimp::IOSystem {
public:
  OneFile(std::string name, const void *content, size_t size)
      : name_(std::move(name)), content_(static_cast<const uint8_t *>(content)), size_(size) {}
  bool Exists(const char *file) const override { return name_ == file; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream *Open(const char *file, const char *) override {
    if (name_ == file) return new Assimp::MemoryIOStream(content_, size_);
    refused = file;
    return nullptr;
  }
  void Close(Assimp::IOStream *stream) override { delete stream; }

  std::string refused; /* the last other file that was asked for */

private:
  const std::string name_;
  const uint8_t *content_;
  const size_t size_;
};

/* Importers drop faces with a wrong index, and only log them. Such a mesh would have holes, so it is refused. */
class Listener : public Assimp::LogStream {
public:
  void write(const char *text) override {
    if (std::strstr(text, "out-of-range") || std::strstr(text, "out of range") || std::strstr(text, "invalid index"))
      complained = true;
  }
  static bool complained;
};
bool Listener::complained;

void keep_one_importer(Assimp::Importer &importer, const std::string &extension) {
  std::vector<Assimp::BaseImporter *> others;
  for (size_t i = 0; i < importer.GetImporterCount(); i++) {
    const aiImporterDesc *description = importer.GetImporterInfo(i);
    std::istringstream extensions(description->mFileExtensions);
    bool wanted = false;
    for (std::string one; extensions >> one;) wanted = wanted || one == extension;
    if (std::strcmp(description->mName, "glTF Importer") == 0) wanted = false; /* glTF 1 */
    if (!wanted) others.push_back(importer.GetImporter(i));
  }
  for (Assimp::BaseImporter *other : others) importer.UnregisterLoader(other);
}

/* The request, taken apart. */
struct Request {
  const char *content = nullptr;
  size_t size = 0;
  std::vector<SporeImportMaterial> materials;
  std::vector<SporeImportPicture> pictures;
  std::vector<const char *> bytes; /* of each picture */
  uint64_t look = 0;               /* as in the head */
  size_t worn = 0;                 /* as in the head */
};

/* A picture in the file, or the number of one beside it, from 1; neither: none. */
struct Source {
  const aiTexture *inside = nullptr;
  size_t beside = 0;
  bool operator==(const Source &other) const { return inside == other.inside && beside == other.beside; }
  explicit operator bool() const { return inside || beside; }
};

struct Picture {
  Source of;
  std::string bytes;
};

/* What a mesh of a node wears. */
struct Look {
  Source source;
  float colour[3] = {1, 1, 1}; /* sRGB; white where the file says none, as OBJ and glTF have it */
  bool coloured = false;       /* the file says it */
  float opacity = 1;
  bool mapped = false; /* a picture says the opacity */
  uint32_t dress = SPORE_IMPORT_BARE;
  bool operator==(const Look &other) const {
    return source == other.source && dress == other.dress && coloured == other.coloured &&
           std::equal(colour, colour + 3, other.colour);
  }
};

/* Triangles that follow each other and wear the same. */
struct Range {
  uint64_t first, count;
  size_t part;
  Look look;
};

struct Mesh {
  std::vector<double> vertices;
  std::vector<uint32_t> triangles;
  bool placed = false;       /* it may wear a picture */
  std::vector<float> places; /* then of each corner in its picture, from the upper left corner; 0 where it has none */
  std::vector<Picture> pictures;
  std::vector<SporeImportPart> parts; /* of at least one triangle each */
  std::vector<Range> ranges;          /* in the order of the triangles, and none is empty */
  uint64_t in_parts = 0;              /* triangles */
  uint64_t passed_over = 0;
};

/* Names such as "nodes[2]" are the importer's: the file has none there. So are those of the root of several nodes, and
 * of the one file. */
std::string name_of(const aiString &name) {
  const std::string text = name.C_Str();
  for (const char *made : {"nodes[", "meshes[", "mesh.", "<"})
    if (text.rfind(made, 0) == 0) return "";
  if (text == "ROOT") return "";
  return text;
}

/* The material that the file gives the mesh. A mesh that names none has the importer's own, which is the last one of
 * glTF. */
const aiMaterial *material_of(const aiScene &scene, const aiMesh &mesh) {
  return mesh.mMaterialIndex + 1 < scene.mNumMaterials ? scene.mMaterials[mesh.mMaterialIndex] : nullptr;
}

/* The material that OBJ gives the mesh, as the file beside it describes it; NULL: it does not. */
const SporeImportMaterial *described(const aiScene &scene, const aiMesh &mesh, const Request &request) {
  aiString name;
  if (request.materials.empty() || scene.mMaterials[mesh.mMaterialIndex]->Get(AI_MATKEY_NAME, name) != AI_SUCCESS)
    return nullptr;
  for (const SporeImportMaterial &material : request.materials)
    if (std::strncmp(material.name, name.C_Str(), sizeof material.name - 1) == 0) return &material;
  return nullptr;
}

/* Takes the colour and the opacity that the material of the mesh says. */
void take_colour(const aiScene &scene, const aiMesh &mesh, const Request &request, Look &look) {
  if (const SporeImportMaterial *said = described(scene, mesh, request)) {
    if (said->coloured) std::copy(said->colour, said->colour + 3, look.colour);
    look.coloured = said->coloured;
    if (said->opacity > 0) look.opacity = said->opacity;
    look.mapped = said->mapped;
    return;
  }
  const aiMaterial *material = material_of(scene, mesh);
  aiColor4D colour;
  if (!material || material->Get(AI_MATKEY_BASE_COLOR, colour) != AI_SUCCESS) return;
  const float light[3] = {colour.r, colour.g, colour.b};
  if (!std::all_of(light, light + 3, [](float one) { return std::isfinite(one); })) return;
  std::transform(light, light + 3, look.colour,
                 [](float one) { return static_cast<float>(spore_srgb(std::min(std::max(one, 0.0f), 1.0f))); });
  look.coloured = true;
  aiString mode;
  if (material->Get(AI_MATKEY_GLTF_ALPHAMODE, mode) == AI_SUCCESS && std::strcmp(mode.C_Str(), "BLEND") == 0 &&
      colour.a > 0 && colour.a < 1)
    look.opacity = colour.a;
}

/* The name of the picture, whose signs may be written as codes. */
bool is_called(const SporeImportPicture &picture, const char *name) {
  std::string plain;
  for (const char *at = picture.name; *at; at++) {
    unsigned code;
    if (*at == '%' && std::sscanf(at + 1, "%2x", &code) == 1 && at[1] && at[2])
      plain += static_cast<char>(code), at += 2;
    else plain += *at;
  }
  return std::strcmp(picture.name, name) == 0 || plain == name;
}

/* The picture that the material of the mesh names. *dress: what the mesh wears. */
Source named_by(const aiScene &scene, const aiMesh &mesh, const Request &request, uint32_t *dress) {
  Source source;
  const SporeImportMaterial *said = described(scene, mesh, request);
  const aiMaterial *material = material_of(scene, mesh);
  aiString path;
  *dress = SPORE_IMPORT_BARE;
  if (request.worn) source.beside = request.worn;
  else if (said) source.beside = said->picture;
  else if (material && material->GetTexture(aiTextureType_BASE_COLOR, 0, &path) == AI_SUCCESS) {
    *dress = SPORE_IMPORT_UNKNOWN;
    source.inside = scene.GetEmbeddedTexture(path.C_Str());
    for (size_t i = 0; i < request.pictures.size() && !source; i++)
      if (is_called(request.pictures[i], path.C_Str())) source.beside = i + 1;
  }
  if (source) *dress = SPORE_IMPORT_WORN;
  return source;
}

/* The picture that the mesh can wear. */
Source picture_of(const aiScene &scene, const aiMesh &mesh, const Request &request, uint32_t *dress) {
  const Source source = named_by(scene, mesh, request, dress);
  if (!source) return source;
  const bool fits =
      !source.inside || (source.inside->mHeight == 0 && source.inside->mWidth <= SPORE_IMPORT_PICTURE_BYTES);
  *dress = !mesh.HasTextureCoords(0) ? SPORE_IMPORT_UNPLACED : fits ? SPORE_IMPORT_WORN : SPORE_IMPORT_UNKNOWN;
  return *dress == SPORE_IMPORT_WORN ? source : Source();
}

/* The picture as PNG where it is a photograph that can be decoded, else as it is in its file. */
std::string content_of(const Source &source, const Request &request) {
  const void *bytes =
      source.inside ? static_cast<const void *>(source.inside->pcData) : request.bytes[source.beside - 1];
  const size_t size = source.inside ? source.inside->mWidth : request.pictures[source.beside - 1].size;
#if SPORE_HAVE_JPEG
  void *png;
  size_t png_size;
  if (spore_photograph_is(bytes, size) && spore_photograph_convert(bytes, size, &png, &png_size)) {
    const std::string content(static_cast<const char *>(png), png_size);
    std::free(png);
    return content;
  }
#endif
  return std::string(static_cast<const char *>(bytes), size);
}

Look look_of(const aiScene &scene, const aiMesh &mesh, const Request &request) {
  Look look;
  if (request.look == SPORE_IMPORT_SHAPE) return look;
  look.source = picture_of(scene, mesh, request, &look.dress);
  if (!request.worn) take_colour(scene, mesh, request, look);
  return look;
}

/* The meshes of a node differ only in material. Together they are one part, whose colour and opacity are those of most
 * of it. */
void end_part(const aiScene &scene, const aiNode &node, const std::string &group, Mesh &mesh) {
  SporeImportPart part = {};
  part.triangle_count = mesh.triangles.size() / 3 - mesh.in_parts;
  if (!part.triangle_count) return;
  mesh.in_parts += part.triangle_count;
  std::string name = name_of(node.mName);
  if (name.empty()) name = name_of(scene.mMeshes[node.mMeshes[0]]->mName);
  name.copy(part.name, sizeof part.name - 1);
  group.copy(part.group, sizeof part.group - 1);
  const Range *largest = nullptr;
  for (const Range &range : mesh.ranges)
    if (range.part == mesh.parts.size() && (!largest || range.count > largest->count)) largest = &range;
  std::copy(largest->look.colour, largest->look.colour + 3, part.colour);
  part.coloured = largest->look.coloured;
  part.opacity = largest->look.opacity;
  for (const Range &range : mesh.ranges) {
    if (range.part != mesh.parts.size()) continue;
    if (range.look.opacity != part.opacity) part.unclear |= SPORE_IMPORT_OPACITIES;
    if (range.look.mapped) part.unclear |= SPORE_IMPORT_OPACITY_MAP;
  }
  mesh.parts.push_back(part);
}

/* Some of the ranges, which wear one picture together. */
using Ranges = std::vector<Range *>;

/* The number, from 1, of a picture of the answer; 0: there are too many. */
uint32_t keep_picture(const Source &source, std::string content, Mesh &mesh) {
  if (mesh.pictures.size() == SPORE_IMPORT_PICTURES_MAXIMUM) return 0;
  mesh.pictures.push_back({source, std::move(content)});
  return static_cast<uint32_t>(mesh.pictures.size());
}

/* The number of the picture of a file. */
uint32_t number_of(const Source &source, const Request &request, Mesh &mesh) {
  for (size_t i = 0; i < mesh.pictures.size(); i++)
    if (mesh.pictures[i].of == source) return static_cast<uint32_t>(i + 1);
  return keep_picture(source, content_of(source, request), mesh);
}

#if SPORE_HAVE_PNG
/* Shifts each triangle by whole pictures, so that it begins in the first one, and tells the places used. */
void unroll(const Range &range, Mesh &mesh, SporeAtlasLook &look) {
  for (uint64_t t = range.first; t < range.first + range.count; t++)
    for (int k = 0; k < 2; k++) {
      float *corners = mesh.places.data() + 6 * t + k, least = HUGE_VALF, most = -HUGE_VALF;
      for (int c = 0; c < 3; c++) {
        if (!(std::fabs(corners[2 * c]) <= 1e6f)) corners[2 * c] = 0;
        least = std::min(least, corners[2 * c]), most = std::max(most, corners[2 * c]);
      }
      const float shift = std::floor(least);
      for (int c = 0; c < 3; c++) corners[2 * c] -= shift;
      look.low[k] = std::min(look.low[k], static_cast<double>(least - shift));
      look.high[k] = std::max(look.high[k], static_cast<double>(most - shift));
    }
}

/* The pictures and looks of ranges, each once. */
struct Palette {
  std::vector<Source> sources;
  std::vector<SporeAtlasPicture> pictures;
  std::vector<SporeAtlasLook> looks;
  std::vector<size_t> look_of; /* of each range */
};

size_t picture_in(Palette &palette, const Source &source, const Request &request) {
  if (!source) return 0;
  const auto found = std::find(palette.sources.begin(), palette.sources.end(), source);
  if (found != palette.sources.end()) return static_cast<size_t>(found - palette.sources.begin()) + 1;
  SporeAtlasPicture picture = {};
  picture.content = source.inside ? static_cast<const void *>(source.inside->pcData) : request.bytes[source.beside - 1];
  picture.size = source.inside ? source.inside->mWidth : request.pictures[source.beside - 1].size;
  palette.sources.push_back(source);
  palette.pictures.push_back(picture);
  return palette.sources.size();
}

Palette palette_of(const Ranges &ranges, const Request &request, Mesh &mesh) {
  Palette palette;
  for (const Range *range : ranges) {
    SporeAtlasLook look = {};
    look.picture = picture_in(palette, range->look.source, request);
    std::copy(range->look.colour, range->look.colour + 3, look.colour);
    for (int k = 0; k < 2; k++) look.low[k] = HUGE_VAL, look.high[k] = -HUGE_VAL;
    auto found = std::find_if(palette.looks.begin(), palette.looks.end(), [&look](const SporeAtlasLook &other) {
      return other.picture == look.picture && std::equal(look.colour, look.colour + 3, other.colour);
    });
    if (found == palette.looks.end()) found = palette.looks.insert(found, look);
    palette.look_of.push_back(static_cast<size_t>(found - palette.looks.begin()));
    unroll(*range, mesh, *found);
  }
  return palette;
}

/* Makes one picture of what the ranges wear, and moves their places there. 0: it cannot be made. */
uint32_t make_atlas(const Ranges &ranges, const Request &request, Mesh &mesh, SporeImportPart &worn) {
  Palette palette = palette_of(ranges, request, mesh);
  void *png;
  size_t size;
  if (palette.sources.size() > SPORE_IMPORT_PICTURES_MAXIMUM ||
      !spore_atlas_make(palette.pictures.data(), palette.pictures.size(), palette.looks.data(), palette.looks.size(),
                        &png, &size))
    return 0;
  const std::string content(static_cast<const char *>(png), size);
  std::free(png);
  for (size_t r = 0; r < ranges.size(); r++) {
    const SporeAtlasLook &look = palette.looks[palette.look_of[r]];
    for (uint64_t i = 6 * ranges[r]->first; i < 6 * (ranges[r]->first + ranges[r]->count); i++)
      mesh.places[i] = static_cast<float>(mesh.places[i] * look.scale[i % 2] + look.offset[i % 2]);
  }
  worn.dress = SPORE_IMPORT_WORN;
  for (const SporeAtlasPicture &picture : palette.pictures)
    if (picture.smaller) worn.dress = SPORE_IMPORT_SMALLER;
  for (const Range *range : ranges)
    if (!range->look.source && range->look.dress != SPORE_IMPORT_BARE) worn.dress = SPORE_IMPORT_PARTLY;
  for (size_t i = 0; i < palette.pictures.size(); i++)
    if (palette.pictures[i].lost) worn.dress = SPORE_IMPORT_PARTLY, worn.missing = palette.sources[i].beside;
  return keep_picture(Source(), content, mesh);
}
#else
uint32_t make_atlas(const Ranges &, const Request &, Mesh &, SporeImportPart &) { return 0; }
#endif

/* Whether one picture must show what the ranges wear: where they differ, and not only in the colour of parts. */
bool are_mixed(const Ranges &ranges) {
  bool pictured = false, differ = false, part_differs = false;
  for (size_t r = 0; r < ranges.size(); r++) {
    pictured = pictured || ranges[r]->look.source;
    if (r == 0 || ranges[r]->look == ranges[r - 1]->look) continue;
    differ = true;
    part_differs = part_differs || ranges[r]->part == ranges[r - 1]->part;
  }
  return part_differs || (pictured && differ);
}

/* Says of the parts what their ranges wear. */
void dress(const Ranges &ranges, const Request &request, Mesh &mesh) {
  const Look &look = ranges[0]->look;
  SporeImportPart worn = {};
  worn.dress = SPORE_IMPORT_MIXED;
  const bool mixed = are_mixed(ranges);
  if (mixed) worn.picture = make_atlas(ranges, request, mesh, worn);
  else if (look.source) worn.picture = number_of(look.source, request, mesh);
  if (!mixed) worn.dress = look.source && !worn.picture ? static_cast<uint32_t>(SPORE_IMPORT_UNKNOWN) : look.dress;
  else if (!worn.picture) worn.dress = SPORE_IMPORT_MIXED;
  for (const Range *range : ranges) {
    SporeImportPart &part = mesh.parts[range->part];
    part.dress = worn.dress, part.picture = worn.picture, part.missing = worn.missing;
    if (mixed && worn.picture) std::fill(part.colour, part.colour + 3, 1.0f), part.coloured = 1;
  }
}

void dress_all(const Request &request, Mesh &mesh) {
  Ranges ranges;
  for (size_t r = 0; r < mesh.ranges.size(); r++) {
    ranges.push_back(&mesh.ranges[r]);
    const bool ends = r + 1 == mesh.ranges.size() ||
                      (request.look == SPORE_IMPORT_APART && mesh.ranges[r + 1].part != mesh.ranges[r].part);
    if (!ends) continue;
    dress(ranges, request, mesh);
    ranges.clear();
  }
}

/* said: how the material moves and repeats its picture; nullptr: not at all. */
void append_faces(const aiMesh &from, uint64_t first, bool mirrored, const SporeImportMaterial *said, Mesh &mesh) {
  for (unsigned f = 0; f < from.mNumFaces; f++) {
    const aiFace &face = from.mFaces[f];
    if (face.mNumIndices != 3) {
      mesh.passed_over++;
      continue;
    }
    for (int c = 0; c < 3; c++) {
      unsigned index = face.mIndices[mirrored && c ? 3 - c : c];
      if (index >= from.mNumVertices)
        throw Refusal{SPORE_ERROR_INPUT,
                      N_("a face names a vertex that is not there; expected indices of the mesh's own "
                         "vertices; repair or export the mesh again"),
                      "face " + std::to_string(f) + ", vertex " + std::to_string(index) + " of " +
                          std::to_string(from.mNumVertices)};
      mesh.triangles.push_back(static_cast<uint32_t>(first + index));
      if (!mesh.placed) continue;
      aiVector3D place = from.HasTextureCoords(0) ? from.mTextureCoords[0][index] : aiVector3D(0, 1, 0);
      if (said)
        place.x = place.x * said->scale[0] + said->offset[0], place.y = place.y * said->scale[1] + said->offset[1];
      mesh.places.insert(mesh.places.end(), {place.x, 1 - place.y}); /* the importer counts from below */
    }
  }
}

/* group: the names of the nodes that the node lies in. */
void append(const aiScene &scene, const aiNode &node, const Request &request, const aiMatrix4x4 &outer,
            const std::string &group, Mesh &mesh) {
  const aiMatrix4x4 transform = outer * node.mTransformation;
  const bool mirrored = transform.Determinant() < 0;
  for (unsigned m = 0; m < node.mNumMeshes; m++) {
    const aiMesh &from = *scene.mMeshes[node.mMeshes[m]];
    const uint64_t first = mesh.vertices.size() / 3;
    if (first + from.mNumVertices > most_elements || mesh.triangles.size() / 3 + from.mNumFaces > most_elements)
      throw Refusal{SPORE_ERROR_INPUT,
                    N_("the mesh is too large; expected at most 20 million vertices and as many "
                       "triangles; decimate it first"),
                    ""};
    for (unsigned v = 0; v < from.mNumVertices; v++) {
      const aiVector3D p = transform * from.mVertices[v];
      mesh.vertices.insert(mesh.vertices.end(), {p.x, p.y, p.z});
    }
    const uint64_t before = mesh.triangles.size() / 3;
    append_faces(from, first, mirrored, request.worn ? nullptr : described(scene, from, request), mesh);
    const uint64_t count = mesh.triangles.size() / 3 - before;
    if (count) mesh.ranges.push_back({before, count, mesh.parts.size(), look_of(scene, from, request)});
  }
  end_part(scene, node, group, mesh);
  const std::string name = name_of(node.mName);
  const std::string inner = name.empty() ? group : group.empty() ? name : group + "/" + name;
  for (unsigned c = 0; c < node.mNumChildren; c++) append(scene, *node.mChildren[c], request, transform, inner, mesh);
}

void check_faces(const aiScene &scene) {
  for (unsigned m = 0; m < scene.mNumMeshes; m++)
    for (unsigned f = 0; f < scene.mMeshes[m]->mNumFaces; f++) {
      const unsigned corners = scene.mMeshes[m]->mFaces[f].mNumIndices;
      if (corners > SPORE_FACE_CORNERS_MAXIMUM)
        throw Refusal{SPORE_ERROR_INPUT,
                      N_("a face has too many corners; expected at most 10000; cut it into triangles first"),
                      "face " + std::to_string(f) + ", " + std::to_string(corners) + " corners"};
    }
}

/* The importer counts the numbers of an OBJ line by their first sign or digit. It misses a number that begins with its
 * decimal point. */
std::string with_leading_zeros(const char *content, size_t size) {
  std::string text;
  text.reserve(size + size / 16);
  bool vertex = false, number = false; /* in a line with coordinates; a number with only its sign so far */
  for (size_t i = 0; i < size; i++) {
    const char c = content[i];
    const bool begins = i == 0 || content[i - 1] == '\n' || content[i - 1] == '\r';
    if (begins) vertex = c == 'v';
    if (c == '.' && vertex && number) text += '0';
    number = c == ' ' || c == '\t' || (number && (c == '-' || c == '+'));
    text += c;
  }
  return text;
}

Request take_apart(const SporeImportRequest &head, const char *rest) {
  Request request;
  request.materials.resize(head.material_count);
  for (SporeImportMaterial &material : request.materials) {
    std::memcpy(&material, rest, sizeof material);
    rest += sizeof material;
  }
  request.pictures.resize(head.picture_count);
  for (SporeImportPicture &picture : request.pictures) {
    std::memcpy(&picture, rest, sizeof picture);
    rest += sizeof picture;
  }
  request.content = rest;
  request.size = head.size;
  request.look = head.look;
  request.worn = head.worn;
  const char *at = request.content + head.size;
  for (const SporeImportPicture &picture : request.pictures) {
    request.bytes.push_back(at);
    at += picture.size;
  }
  return request;
}

Mesh import(const char *extension, const Request &request) {
  const void *content = request.content;
  size_t size = request.size;
  std::string zeros;
  if (std::strcmp(extension, "obj") == 0) {
    zeros = with_leading_zeros(request.content, size);
    content = zeros.data(), size = zeros.size();
  }
  const std::string name = std::string("mesh.") + extension;
  Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
  Assimp::DefaultLogger::get()->attachStream(new Listener, Assimp::Logger::Warn | Assimp::Logger::Err);
  Assimp::Importer importer;
  keep_one_importer(importer, extension);
  OneFile *files = new OneFile(name, content, size);
  importer.SetIOHandler(files); /* takes ownership */
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, 0);
  const aiScene *scene = importer.ReadFile(name, 0);
  if (scene) check_faces(*scene);
  if (scene) scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  const std::string said = scene ? "" : importer.GetErrorString();
  if (Listener::complained)
    throw Refusal{SPORE_ERROR_INPUT,
                  N_("a face names a vertex that is not there; expected indices of the mesh's own "
                     "vertices; repair or export the mesh again"),
                  ""};
  if (!scene && !files->refused.empty())
    throw Refusal{SPORE_ERROR_INPUT,
                  N_("the mesh keeps a part in another file, which is not read; expected all in one "
                     "file; export it as GLB, or with embedded data"),
                  files->refused};
  if (!scene)
    throw Refusal{SPORE_ERROR_INPUT, N_("the mesh cannot be read; expected a sound file; export it again"), said};
  Mesh mesh;
  mesh.placed = request.look != SPORE_IMPORT_SHAPE &&
                (scene->HasTextures() || !request.pictures.empty() || scene->mNumMaterials > 1);
  if (scene->mRootNode) append(*scene, *scene->mRootNode, request, aiMatrix4x4(), "", mesh);
  dress_all(request, mesh);
  if (mesh.triangles.empty())
    throw Refusal{SPORE_ERROR_INPUT,
                  mesh.vertices.empty()
                      ? N_("there is no mesh in the file; expected triangles; export it again")
                      : N_("there are only points or lines in the file; expected triangles; export the "
                           "surface"),
                  ""};
  return mesh;
}

void *make_answer(const Mesh &mesh, size_t *size) {
  const SporeImportAnswer head = {mesh.parts.size(), mesh.vertices.size() / 3, mesh.triangles.size() / 3,
                                  mesh.passed_over, mesh.pictures.size()};
  const size_t part_bytes = mesh.parts.size() * sizeof(SporeImportPart);
  const size_t vertex_bytes = mesh.vertices.size() * sizeof(double);
  const size_t triangle_bytes = mesh.triangles.size() * sizeof(uint32_t);
  size_t place_bytes = mesh.pictures.empty() ? 0 : mesh.places.size() * sizeof(float), picture_bytes = 0;
  for (const Picture &picture : mesh.pictures) picture_bytes += sizeof(SporeImportTaken) + picture.bytes.size();
  *size = sizeof head + part_bytes + vertex_bytes + triangle_bytes + place_bytes + picture_bytes;
  char *answer = static_cast<char *>(std::malloc(*size));
  if (!answer) throw std::bad_alloc();
  std::memcpy(answer, &head, sizeof head);
  char *at = answer + sizeof head;
  std::memcpy(at, mesh.parts.data(), part_bytes);
  std::memcpy(at + part_bytes, mesh.vertices.data(), vertex_bytes);
  std::memcpy(at + part_bytes + vertex_bytes, mesh.triangles.data(), triangle_bytes);
  at += part_bytes + vertex_bytes + triangle_bytes;
  std::memcpy(at, mesh.places.data(), place_bytes);
  at += place_bytes;
  for (const Picture &picture : mesh.pictures) {
    const SporeImportTaken taken = {picture.bytes.size(), picture.of.beside};
    std::memcpy(at, &taken, sizeof taken);
    at += sizeof taken;
  }
  for (const Picture &picture : mesh.pictures) {
    std::memcpy(at, picture.bytes.data(), picture.bytes.size());
    at += picture.bytes.size();
  }
  return answer;
}

bool fail(SporeHelperFailure *failure, SporeErrorCode code, const char *message, const char *detail) {
  failure->code = code;
  failure->message = message;
  std::snprintf(failure->detail, sizeof failure->detail, "%s", detail);
  return false;
}

} // namespace

bool spore_import_assimp(const char *extension, const SporeImportRequest *head, const char *rest, void **answer,
                         size_t *answer_size, SporeHelperFailure *failure) {
  try {
    *answer = make_answer(import(extension, take_apart(*head, rest)), answer_size);
    return true;
  } catch (const Refusal &refusal) {
    return fail(failure, refusal.code, refusal.message, refusal.detail.c_str());
  } catch (const std::bad_alloc &) {
    return fail(failure, SPORE_ERROR_MEMORY,
                N_("the mesh needs more memory than it may have; expected a smaller one; decimate it first"), "");
  } catch (const std::exception &exception) {
    return fail(failure, SPORE_ERROR_INPUT, N_("the mesh cannot be read; expected a sound file; export it again"),
                exception.what());
  }
}
