/* What the tests in C have in common. */
#ifndef CHECK_H
#define CHECK_H

#include <delray.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHECK(condition)                                                                \
  do {                                                                                  \
    if (!(condition)) {                                                                 \
      fprintf(stderr, "%s:%d: %s (last error: '%s')\n", __FILE__, __LINE__, #condition, \
              delrayErrorText());                                                       \
      exit(1);                                                                          \
    }                                                                                   \
  } while (0)

#define OK(call) CHECK((call) == DELRAY_SUCCESS)
/* The call fails with this code, and a text with this part. */
#define FAILS(code, call, text)                     \
  do {                                              \
    CHECK((call) == (code));                        \
    CHECK(strstr(delrayErrorText(), text) != NULL); \
  } while (0)

#endif
