// MUSLIN_API marks the classes and functions that the shared library exports.
#pragma once

#define MUSLIN_API __attribute__((visibility("default")))
