MODULE M
  PROC main()
    MoveAbsJ [[1,2,9E9,4,5,6],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;
    MoveAbsJ [[9E9,9E9,9E9,9E9,9E9,9E9],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;
    MoveAbsJ [[1,2,3,4,5,6]],v100,fine,tool0;
    MoveAbsJ [[1,2,3,4,5,6,7],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;
  ENDPROC
ENDMODULE
