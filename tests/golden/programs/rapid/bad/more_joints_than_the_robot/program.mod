MODULE M
  PROC main()
    MoveAbsJ [[1,2,3,4,5,6],[100,9E9,9E9,9E9,9E9,9E9]],vmax,fine,tool0;
  ENDPROC
ENDMODULE
