#include "muslin/muslin.hpp"

int main() { return 0; }
