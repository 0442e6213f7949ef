MODULE M
  PROC main()
    MoveAbsJ [[10,20,30,9E9,9E9,9E9],[9E9,9E9,9E9,9E9,9E9,9E9]],vmax,fine,tool0;
    MoveAbsJ [[10,20,30,40,50,60],[9E9,9E9,9E9,9E9,9E9,9E9]],vmax,fine,tool0;
  ENDPROC
ENDMODULE
