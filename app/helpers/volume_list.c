/* spore-volume-list: which labels a label map holds, in the sandbox. */
#include "app/helpers/serve.h"
#include "app/helpers/volume.h"

int main(int argc, char **argv) { spore_helper_serve(argc, argv, spore_volume_survey); }
