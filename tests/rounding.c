/* Changes one result in ten of the C library's elementary functions by one unit in the last place, as the C libraries of other
 * processors do; f(-x) = -f(x) and f(-x) = f(x) stay. Which results, the number ROUNDING_SEED says (1).
 *
 *     cc -O1 -fno-builtin -shared -fPIC -o rounding.so tests/rounding.c -ldl -lm && LD_PRELOAD=./rounding.so gudgeon CASE.nml */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static uint64_t seed = 1;

__attribute__((constructor)) static void read_seed(void) {
  const char *text = getenv("ROUNDING_SEED");
  if (text) seed = strtoull(text, 0, 10);
}

static double changed(double result, double x, double y) {
  uint64_t a, b, hash;
  if (!isfinite(result) || result == 0 || fabs(result) == 1) return result;
  x = fabs(x);
  y = fabs(y);
  memcpy(&a, &x, sizeof a);
  memcpy(&b, &y, sizeof b);
  hash = a * 0x9E3779B97F4A7C15u ^ (b + seed) * 0xC2B2AE3D27D4EB4Fu;
  hash = (hash ^ hash >> 29) * 0xBF58476D1CE4E5B9u;
  hash ^= hash >> 32;
  if (hash % 20 > 1) return result;
  return copysign(nextafter(fabs(result), hash % 20 ? 0 : INFINITY), result);
}

#define ONE(f) double f(double x) { \
  static double (*library)(double); \
  if (!library) library = (double (*)(double))dlsym(RTLD_NEXT, #f); \
  return changed(library(x), x, 0); }
#define TWO(f) double f(double x, double y) { \
  static double (*library)(double, double); \
  if (!library) library = (double (*)(double, double))dlsym(RTLD_NEXT, #f); \
  return changed(library(x, y), x, y); }
ONE(sin) ONE(cos) ONE(tan) ONE(asin) ONE(acos) ONE(atan) ONE(sinh) ONE(cosh) ONE(tanh) ONE(exp) ONE(log) ONE(log10) TWO(pow) TWO(atan2)

void sincos(double x, double *sine, double *cosine) {
  *sine = sin(x);
  *cosine = cos(x);
}
