// Depth alone: shadow map and the skin's first pass.
void main() {}
