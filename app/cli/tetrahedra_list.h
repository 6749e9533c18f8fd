/* spore tetrahedra --list. */
#ifndef SPORE_APP_CLI_TETRAHEDRA_LIST_H
#define SPORE_APP_CLI_TETRAHEDRA_LIST_H

#include "app/cli/cli.h"
#include "core/io/label_survey.h"

/* Reports the labels of a map: the members `labels`, and of each of them label, name, named, voxels, volume_m3, size_m
 * and cut. */
void spore_cli_report_list(SporeCli *cli, const SporeLabelSurvey *survey);
/* The sides of the volume that a label reaches, which may cut it: the member `cut`; and in words, behind what was said
 * of the label. */
void spore_cli_report_sides(SporeCli *cli, const SporeLabelEntry *entry);
void spore_cli_say_sides(const SporeCli *cli, const SporeLabelEntry *entry);

#endif
