// Float4 holds four floats in a register.
#pragma once

namespace muslin {

using Float4 = float __attribute__((vector_size(16)));

}  // namespace muslin
