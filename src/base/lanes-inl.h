// Names of the vectors that vector code computes with. Included once per instruction set.
#if defined(SEARCHLIGHT_BASE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SEARCHLIGHT_BASE_LANES_INL_H_
#undef SEARCHLIGHT_BASE_LANES_INL_H_
#else
#define SEARCHLIGHT_BASE_LANES_INL_H_
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// 16 lanes where the hardware has them, otherwise what it has: lane i computes the same either way.
using Float = hn::CappedTag<float, 16>;
using Int = hn::RebindToSigned<Float>;
using FloatV = hn::Vec<Float>;
using IntV = hn::Vec<Int>;
using FloatM = hn::Mask<Float>;

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#endif
