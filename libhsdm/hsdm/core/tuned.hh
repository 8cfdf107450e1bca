#pragma once
// Tuning values: constants, but in a build that tries others (-DHSDM_SENSITIVITY=ON, docs/constants.md).
//
//     /// voxels: what it is.
//     /// Why: the reason for this value.
//     HSDM_TUNED double margin = 0.002;
//
// stands in a folder's constants.hh, in the namespace of its stage. docs/sensitivity.py reads unit, meaning
// and reason from there, so the form matters. Values that only bound the work of a chunk, guard against
// rounding or are limits of a format are no tuning values and stay where they are used. What changed nothing
// at half and double is a plain decision: the same form, but with `inline constexpr`.

#ifdef HSDM_SENSITIVITY
#define HSDM_TUNED inline // set before main() from the environment: HSDM_TUNED="placement.margin=0.004"
#else
#define HSDM_TUNED inline constexpr
#endif
