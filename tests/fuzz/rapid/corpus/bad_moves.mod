MODULE M
  CONST robtarget p1:=[[600,100,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveL;
    MoveL p1;
    MoveL p1,v100;
    MoveL p1,v100,fine;
    MoveL p1,v100,fine,;
    MoveJ p1 v100,fine,tool0;
    MoveJ *,v100,fine,tool0;
  ENDPROC
ENDMODULE
