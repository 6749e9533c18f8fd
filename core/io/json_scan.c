/* Steps through the text of JSON (RFC 8259). The text is untrusted: nothing is expanded, and no depth is believed. */
#include "core/io/json_scan.h"

#include <string.h>

#define DEEPEST_VALUE 100

gboolean spore_json_fail(SporeJson *json) {
  json->bad = TRUE;
  return FALSE;
}

gboolean spore_json_take(SporeJson *json, char wanted) {
  while (json->at < json->end && strchr(" \t\n\r", *json->at) && *json->at) json->at++;
  if (json->bad || json->at == json->end || *json->at != wanted) return FALSE;
  json->at++;
  return TRUE;
}

gboolean spore_json_string(SporeJson *json, SporeJsonText *string) {
  if (!spore_json_take(json, '"')) return spore_json_fail(json);
  string->text = json->at;
  for (; json->at < json->end && *json->at != '"'; json->at++)
    if (*json->at == '\\') json->at++;
  if (json->at >= json->end) return spore_json_fail(json);
  string->length = (gsize)(json->at++ - string->text);
  return TRUE;
}

gboolean spore_json_scalar(SporeJson *json, SporeJsonText *scalar) {
  scalar->text = json->at;
  while (json->at < json->end && (g_ascii_isalnum(*json->at) || strchr("+-.", *json->at)) && *json->at) json->at++;
  scalar->length = (gsize)(json->at - scalar->text);
  return scalar->length > 0 || spore_json_fail(json);
}

gboolean spore_json_next_item(SporeJson *json, char close, gsize *count) {
  if (json->bad || spore_json_take(json, close)) return FALSE;
  if (*count > 0 && !spore_json_take(json, ',')) return spore_json_fail(json);
  ++*count;
  return TRUE;
}

gboolean spore_json_next_member(SporeJson *json, gsize *count, SporeJsonText *key) {
  if (!spore_json_next_item(json, '}', count)) return FALSE;
  return spore_json_string(json, key) && (spore_json_take(json, ':') || spore_json_fail(json));
}

void spore_json_skip(SporeJson *json, int depth) {
  gsize count = 0;
  SporeJsonText key;
  if (depth > DEEPEST_VALUE) spore_json_fail(json);
  else if (spore_json_take(json, '{'))
    while (spore_json_next_member(json, &count, &key)) spore_json_skip(json, depth + 1);
  else if (spore_json_take(json, '['))
    while (spore_json_next_item(json, ']', &count)) spore_json_skip(json, depth + 1);
  else if (json->at < json->end && *json->at == '"') spore_json_string(json, &key);
  else if (!json->bad) spore_json_scalar(json, &key);
}
