#include "io/shape_file.h"
