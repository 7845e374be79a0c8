#include "render/view.h"
#include "render/exitance_sum.h"
#include "render/technique.h"
