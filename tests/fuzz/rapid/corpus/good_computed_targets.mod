MODULE M
  VAR num n;
  PROC main()
    n:=25;
    MoveL [[n*2,n+1,400],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;
    MoveAbsJ [[n,0,-n,0,2*n,0],[9E9,9E9,9E9,9E9,9E9,9E9]],vmax,fine,tool0;
  ENDPROC
ENDMODULE
