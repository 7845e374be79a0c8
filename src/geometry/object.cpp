#include "geometry/object.h"
