
/* Field in the orbit frame, nT: x along the motion, y against the orbit's normal, z to the Earth.
 */
static inline void field_table_lookup(double behind_first_rad, double field_nt[3]) {
  const double place =
      field_table_within(behind_first_rad) / 6.283185307179586 * (FIELD_TABLE_ROWS - 1);
  int row = 0;
  double share;
  int axis;
  if (place >= FIELD_TABLE_ROWS - 1) {
    row = FIELD_TABLE_ROWS - 2;
  } else if (place > 0.0) { /* not of an anomaly that is no number */
    row = (int)place;
  }
  share = place - row;
  for (axis = 0; axis < 3; ++axis) {
    field_nt[axis] = (1.0 - share) * (double)field_table_nt[row][axis] +
                     share * (double)field_table_nt[row + 1][axis];
  }
}
