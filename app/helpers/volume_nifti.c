/* NIfTI-1 and NIfTI-2 in one file (.nii): nifti1.h and nifti2.h of the NIfTI Data Format Working Group, 2005 and 2011.
 */
#include <math.h>
#include <string.h>

#include "app/helpers/volume.h"

#define N_(text) text
#define HEADER_1 348
#define HEADER_2 540

typedef struct Header {
  const uint8_t *bytes;
  bool swapped, second; /* second: NIfTI-2, whose members are wider and lie elsewhere */
} Header;

static void take(const Header *header, size_t offset, void *value, size_t size) {
  uint8_t *to = value;
  for (size_t i = 0; i < size; i++) to[header->swapped ? size - 1 - i : i] = header->bytes[offset + i];
}

/* Members by their offsets in both headers. NIfTI-1 has 16-bit integers and 32-bit reals; NIfTI-2 has 64-bit integers
 * (32-bit for codes) and 64-bit reals. */
static int64_t take_count(const Header *header, size_t first, size_t second) {
  int16_t narrow;
  int64_t wide;
  if (header->second) take(header, second, &wide, sizeof wide);
  else take(header, first, &narrow, sizeof narrow);
  return header->second ? wide : narrow;
}
static int take_code(const Header *header, size_t first, size_t second) {
  int16_t narrow;
  int32_t wide;
  if (header->second) take(header, second, &wide, sizeof wide);
  else take(header, first, &narrow, sizeof narrow);
  return header->second ? wide : narrow;
}
/* The i-th number of an array. */
static double take_real(const Header *header, size_t first, size_t second, size_t i) {
  float narrow;
  double wide;
  if (header->second) take(header, second + i * sizeof wide, &wide, sizeof wide);
  else take(header, first + i * sizeof narrow, &narrow, sizeof narrow);
  return header->second ? wide : (double)narrow;
}

static double voxel_size(const Header *header, size_t k) { return take_real(header, 76, 104, k + 1); }

static bool take_type(const Header *header, SporeVoxelType *type, SporeHelperFailure *failure) {
  static const struct {
    int16_t code;
    SporeVoxelType type;
  } known[] = {{2, SPORE_VOXEL_UINT8},     {256, SPORE_VOXEL_INT8},   {512, SPORE_VOXEL_UINT16},
               {4, SPORE_VOXEL_INT16},     {768, SPORE_VOXEL_UINT32}, {8, SPORE_VOXEL_INT32},
               {1280, SPORE_VOXEL_UINT64}, {1024, SPORE_VOXEL_INT64}, {16, SPORE_VOXEL_FLOAT},
               {64, SPORE_VOXEL_DOUBLE}};
  int16_t code;
  take(header, header->second ? 12 : 70, &code, sizeof code);
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (known[i].code == code) {
      *type = known[i].type;
      return true;
    }
  return spore_helper_fail(failure,
                           N_("its voxels are of a kind that holds no labels; expected integers or real numbers; save "
                              "it as a label map"),
                           "datatype %d", code);
}

/* More than three dimensions are accepted where the others have a length of 1. */
static bool take_size(const Header *header, uint64_t size[3], SporeHelperFailure *failure) {
  int64_t dimensions = take_count(header, 40, 16);
  for (int i = 0; i < 7; i++) {
    int64_t length = i < dimensions ? take_count(header, 42 + 2 * (size_t)i, 24 + 8 * (size_t)i) : 1;
    if (dimensions < 1 || dimensions > 7 || length < 1 || (i >= 3 && length > 1))
      return spore_helper_fail(failure,
                               N_("its dimensions are not those of a volume; expected three of at least one "
                                  "voxel; save one volume of it"),
                               "dim[%d] = %lld", i < dimensions ? i + 1 : 0,
                               (long long)(i < dimensions ? length : dimensions));
    if (i < 3) size[i] = (uint64_t)length;
  }
  return true;
}

/* Method 2 of the standard: a rotation as a quaternion, voxel sizes, and a translation. */
static void axes_of_quaternion(const Header *header, double axes[12]) {
  double b = take_real(header, 256, 352, 0), c = take_real(header, 256, 352, 1), d = take_real(header, 256, 352, 2);
  double rest = 1 - (b * b + c * c + d * d);
  if (rest < 1e-7) { /* as the standard's own code does: a half turn */
    double length = 1 / sqrt(b * b + c * c + d * d);
    b *= length, c *= length, d *= length, rest = 0;
  }
  double a = sqrt(fmax(rest, 0));
  const double turn[9] = {a * a + b * b - c * c - d * d, 2 * (b * c - a * d),           2 * (b * d + a * c),
                          2 * (b * c + a * d),           a * a + c * c - b * b - d * d, 2 * (c * d - a * b),
                          2 * (b * d - a * c),           2 * (c * d + a * b),           a * a + d * d - c * c - b * b};
  for (int row = 0; row < 3; row++) {
    for (int k = 0; k < 3; k++) axes[4 * row + k] = turn[3 * row + k] * voxel_size(header, (size_t)k);
    axes[4 * row + 3] = take_real(header, 268, 376, (size_t)row);
  }
  if (take_real(header, 76, 104, 0) < 0) /* qfac */
    for (int row = 0; row < 3; row++) axes[4 * row + 2] = -axes[4 * row + 2];
}

static int take_units(const Header *header) { return header->second ? take_code(header, 0, 500) : header->bytes[123]; }

static void take_axes(const Header *header, double axes[12]) {
  if (take_code(header, 254, 348) > 0)
    for (size_t i = 0; i < 12; i++) axes[i] = take_real(header, 280, 400, i);
  else if (take_code(header, 252, 344) > 0) axes_of_quaternion(header, axes);
  else
    for (size_t i = 0; i < 3; i++) axes[5 * i] = voxel_size(header, i);         /* voxel sizes alone */
  static const double units[8] = {1e-3, 1, 1e-3, 1e-6, 1e-3, 1e-3, 1e-3, 1e-3}; /* not stated: mm */
  for (int i = 0; i < 12; i++) axes[i] *= units[take_units(header) & 7];
}

bool spore_nifti_head(const uint8_t *bytes, size_t size, SporeVolumeHead *head, SporeHelperFailure *failure) {
  Header header = {bytes};
  if (size >= 8) header.second = memcmp(bytes + 4, "n+2", 4) == 0;
  const int32_t whole = header.second ? HEADER_2 : HEADER_1;
  if (!header.second && size >= HEADER_1 && memcmp(bytes + 344, "n+1", 4) != 0)
    return spore_helper_fail(failure,
                             N_("it is no NIfTI-1 or NIfTI-2 volume in one file; expected .nii or .nii.gz with header "
                                "and data together; save it so"),
                             "%s", "");
  if (size < (size_t)whole + 4)
    return spore_helper_fail(failure, N_("the NIfTI file is cut short; expected the whole file; copy it again"),
                             "%zu bytes", size);
  int32_t length;
  take(&header, 0, &length, sizeof length);
  header.swapped = length != whole;
  *head = (SporeVolumeHead){.swapped = header.swapped};
  if (!take_type(&header, &head->type, failure) || !take_size(&header, head->answer.size, failure)) return false;
  take_axes(&header, head->answer.axes);
  head->slope = take_real(&header, 112, 176, 0);
  head->shift = take_real(&header, 116, 184, 0);
  if (head->slope == 0 || !isfinite(head->slope)) head->slope = 1, head->shift = 0; /* not given */
  int64_t start = 0;
  if (header.second) take(&header, 168, &start, sizeof start);
  double offset = header.second ? (double)start : take_real(&header, 108, 0, 0);
  if (!(offset >= whole && offset <= (double)size))
    return spore_helper_fail(failure,
                             N_("its voxels would begin outside the file; expected them behind the header; "
                                "save it again"),
                             "vox_offset %g of %zu bytes", offset, size);
  head->data = (size_t)offset;
  return true;
}
