"""Which solids of a robot and its surroundings touch: proofs, tables and covers; MuJoCo is the reference."""
