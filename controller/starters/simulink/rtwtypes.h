/* SPDX-License-Identifier: BSD-3-Clause */
/* rtwtypes.h - the number types of the model. The model computes in single precision. */
#ifndef RTWTYPES_H
#define RTWTYPES_H

#include <stdbool.h>
#include <stdint.h>

typedef float real32_T;
typedef bool boolean_T;
typedef int32_t int32_T;
typedef uint64_t uint64_T;

#endif /* RTWTYPES_H */
