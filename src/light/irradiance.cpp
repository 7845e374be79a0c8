#include "light/irradiance.h"
