-- Which biases are in the axis.

-- 1: estimated with the axis; 0: it was held at zero, and the row is what the edges would say of all
-- biases together. NULL: stored before this was.
ALTER TABLE spin_bias ADD COLUMN estimated INTEGER CHECK (estimated IN (0, 1));
