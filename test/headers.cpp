// Nothing: the target it belongs to compiles headers that most tests include.
