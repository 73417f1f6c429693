
/* Field in the orbit frame, nT: x along the motion, y against the orbit's normal, z to the Earth.
 */
static inline void field_table_lookup(double behind_first_rad, double field_nt[3]) {
  const double within = field_table_within(behind_first_rad);
  int row = 0;
  int above = FIELD_TABLE_ROWS - 1;
  double share;
  int axis;
  while (above - row > 1) {
    const int middle = (row + above) / 2;
    if ((double)field_table_knots_rad[middle] <= within) {
      row = middle;
    } else {
      above = middle;
    }
  }
  share = (within - (double)field_table_knots_rad[row]) /
          ((double)field_table_knots_rad[above] - (double)field_table_knots_rad[row]);
  for (axis = 0; axis < 3; ++axis) {
    field_nt[axis] = (1.0 - share) * (double)field_table_nt[row][axis] +
                     share * (double)field_table_nt[above][axis];
  }
}
