/* spore-volume: decodes a label map's bytes, in the sandbox. */
#include "app/helpers/volume.h"

#include "app/helpers/serve.h"

int main(int argc, char **argv) { spore_helper_serve(argc, argv, spore_volume_decode); }
