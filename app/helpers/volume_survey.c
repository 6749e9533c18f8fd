/* Counts the voxels of each label, finds the box they lie in, and reads the names that a NIfTI file has for them. */
#include <stdlib.h>
#include <string.h>

#include "app/helpers/volume.h"

#define LABELS 65536
#define CARET 30 /* the code of the extension in which programs keep a table of labels, as XML */

typedef struct Survey {
  SporeVolumeLabel *labels; /* LABELS of them */
  uint16_t *row;
} Survey;

static void add_run(SporeVolumeLabel *label, uint64_t voxels, const uint32_t from[3], uint32_t to) {
  for (int k = 0; k < 3; k++) {
    const uint32_t last = k == 0 ? to : from[k];
    if (!label->voxels || from[k] < label->lower[k]) label->lower[k] = from[k];
    if (!label->voxels || last > label->upper[k]) label->upper[k] = last;
  }
  label->voxels += voxels;
}

/* Adds the runs of equal labels of a row. */
static void add_row(Survey *survey, uint64_t length, uint32_t j, uint32_t k) {
  const uint16_t *row = survey->row;
  for (uint64_t i = 0; i < length;) {
    uint64_t end = i + 1;
    while (end < length && row[end] == row[i]) end++;
    const uint32_t from[3] = {(uint32_t)i, j, k};
    if (row[i]) add_run(&survey->labels[row[i]], end - i, from, (uint32_t)end - 1);
    i = end;
  }
}

static bool add_rows(Survey *survey, const SporeVolumeHead *head, const uint8_t *data, SporeHelperFailure *failure) {
  const uint64_t *size = head->answer.size;
  uint64_t first = 0;
  for (uint64_t k = 0; k < size[2]; k++)
    for (uint64_t j = 0; j < size[1]; j++, first += size[0]) {
      if (!spore_volume_labels(head, data, first, size[0], survey->row, failure)) return false;
      add_row(survey, size[0], (uint32_t)j, (uint32_t)k);
    }
  return true;
}

/* The text behind `open`, up to `close`; NULL: it is not there. */
static const char *between(const char *from, const char *end, const char *open, char close, size_t *length) {
  const char *found = from < end ? memmem(from, (size_t)(end - from), open, strlen(open)) : NULL;
  if (!found) return NULL;
  found += strlen(open);
  const char *last = memchr(found, close, (size_t)(end - found));
  *length = last ? (size_t)(last - found) : 0;
  return last ? found : NULL;
}

/* <Label Key="3" ...>liver</Label>, as Connectome Workbench writes it. */
static void read_table(Survey *survey, const char *text, size_t size) {
  const char *end = text + size, *tag;
  size_t length, digits = 0, letters = 0;
  while ((tag = between(text, end, "<Label ", '>', &length))) {
    const char *key = between(tag, tag + length, "Key=\"", '"', &digits);
    const char *name = between(tag + length, end, ">", '<', &letters);
    char number[8] = "";
    if (key && digits < sizeof number) memcpy(number, key, digits);
    const long label = strtol(number, NULL, 10);
    if (name && label > 0 && label < LABELS && letters < sizeof survey->labels[0].name)
      memcpy(survey->labels[label].name, name, letters);
    text = tag + length;
  }
}

/* The extensions between a NIfTI header and its voxels: size, code, text (nifti.nimh.nih.gov, "extension"). */
static void read_extensions(Survey *survey, const uint8_t *bytes, const SporeVolumeHead *head) {
  const size_t start = memcmp(bytes + 4, "n+2", 4) == 0 ? 540 : 348;
  if (memcmp(bytes, "NRRD", 4) == 0 || head->data < start + 4 || !bytes[start]) return;
  for (size_t at = start + 4; at + 8 <= head->data;) {
    uint32_t size, code;
    memcpy(&size, bytes + at, sizeof size);
    memcpy(&code, bytes + at + 4, sizeof code);
    if (head->swapped) size = __builtin_bswap32(size), code = __builtin_bswap32(code);
    if (size < 8 || size > head->data - at) return;
    if (code == CARET) read_table(survey, (const char *)bytes + at + 8, size - 8);
    at += size;
  }
}

static void *make_answer(const Survey *survey, const SporeVolumeHead *head, size_t *size) {
  SporeVolumeSurvey answer = {.volume = head->answer};
  for (size_t i = 1; i < LABELS; i++) answer.count += survey->labels[i].voxels > 0;
  *size = sizeof answer + (size_t)answer.count * sizeof(SporeVolumeLabel);
  char *whole = malloc(*size), *at = whole ? whole + sizeof answer : NULL;
  if (!whole) return NULL;
  memcpy(whole, &answer, sizeof answer);
  for (size_t i = 1; i < LABELS; i++) {
    if (!survey->labels[i].voxels) continue;
    survey->labels[i].label = (uint32_t)i;
    memcpy(at, &survey->labels[i], sizeof survey->labels[i]);
    at += sizeof survey->labels[i];
  }
  return whole;
}

static bool survey_voxels(const uint8_t *bytes, const SporeVolumeHead *head, const uint8_t *data, void **result,
                          size_t *result_size, SporeHelperFailure *failure) {
  Survey survey = {calloc(LABELS, sizeof *survey.labels), malloc(head->answer.size[0] * sizeof *survey.row)};
  bool done = survey.labels && survey.row;
  if (!done) spore_volume_fail_memory(failure);
  done = done && add_rows(&survey, head, data, failure);
  if (done) read_extensions(&survey, bytes, head);
  *result = done ? make_answer(&survey, head, result_size) : NULL;
  if (done && !*result) spore_volume_fail_memory(failure);
  free(survey.labels);
  free(survey.row);
  return *result != NULL;
}

bool spore_volume_survey(const uint8_t *bytes, size_t size, void **result, size_t *result_size,
                         SporeHelperFailure *failure) {
  return spore_volume_open(bytes, size, survey_voxels, result, result_size, failure);
}
